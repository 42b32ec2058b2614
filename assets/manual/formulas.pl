# What pandoc writes of formulas that browsers do not set as TeX does, line by line of the page: upright words, accents,
# parentheses about what is not tall, which would have too much space.
s{<mstyle mathvariant="normal">((?:<mi>[^<]*</mi>)+)</mstyle>}{my $word = $1 =~ s/<.?mi>//gr; length($word) > 1 ? "<mi>$word</mi>" : "<mi mathvariant=\"normal\">$word</mi>"}ge;
s{(<mo accent="true">)(\x{307}|\x{308}|\x{303})}{$1 . {"\x{307}" => "\x{2d9}", "\x{308}" => "\xa8", "\x{303}" => "\x{2dc}"}->{$2}}ge;
1 while s{<mo stretchy="true" form="prefix">([(|])</mo>((?:(?!stretchy="true" form=|<mtable|<mfrac|<munder).)*?)<mo stretchy="true" form="postfix">([)|])</mo>}{<mo stretchy="false">$1</mo>$2<mo stretchy="false">$3</mo>}g;

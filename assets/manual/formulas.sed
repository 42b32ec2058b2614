# What pandoc writes of formulas that browsers do not set as TeX does: upright words, accents, space around parentheses.
:word
s|(<mstyle mathvariant="normal"><mi>[^<]*)</mi><mi>|\1|
t word
s|<mstyle mathvariant="normal"><mi>([^<][^<]+)</mi></mstyle>|<mi>\1</mi>|g
s|<mstyle mathvariant="normal"><mi>(.)</mi></mstyle>|<mi mathvariant="normal">\1</mi>|g
s|(<mo accent="true">)̇|\1˙|g
s|(<mo accent="true">)̈|\1¨|g
s|(<mo accent="true">)̃|\1˜|g
s|<mo stretchy="true" form=|<mo lspace="0" rspace="0" stretchy="true" form=|g

# usage: perl metadata.pl FILE.pdf TITLE AUTHOR LICENCE DATE
# Chromium leaves author and licence of a book out: appends a table of them to its file.
use strict;
use warnings;
my ($file, $title, $author, $licence, $date) = @ARGV;
open my $pdf, "+<:raw", $file or die "$file: $!\n";
my $text = do { local $/; <$pdf> };
my ($trailer) = $text =~ /trailer\s*<<(.*?)>>\s*startxref\s*(?:\d+)\s*%%EOF\s*$/s or die "$file: no trailer\n";
my ($before) = $text =~ /startxref\s*(\d+)\s*%%EOF\s*$/;
my ($info) = $trailer =~ m{/Info (\d+) 0 R} or die "$file: no table of its data\n";
$trailer =~ s{/Prev \d+}{};
s/([\\()])/\\$1/g for $title, $author, $licence;
(my $day = $date) =~ s/-//g;
my $object = length $text;
my $table = "$info 0 obj\n<</Title ($title)\n/Author ($author)\n/Subject ($licence)\n/Creator (launchdyn)\n" .
    "/CreationDate (D:${day}000000Z)>>\nendobj\n";
my $references = $object + length $table;
print $pdf $table, "xref\n$info 1\n", sprintf("%010d 00000 n \n", $object), "trailer\n<<$trailer\n/Prev $before>>\n",
    "startxref\n$references\n%%EOF\n";
close $pdf or die "$file: $!\n";

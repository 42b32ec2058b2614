# cmake -DFROM=assets/bundle -DINTO=FILE.c -P embed.cmake: the bundle as arrays of bytes.
set(text "// Made by cmake/embed.cmake from assets/bundle.\n#include \"report/report_parts.h\"\n")
foreach(pair script=report.js style=report.css policy=report.policy)
  string(REGEX REPLACE "=.*" "" name ${pair})
  string(REGEX REPLACE ".*=" "" file ${pair})
  file(READ ${FROM}/${file} bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND text "const unsigned char report_${name}[] = {\n${bytes}};\n"
         "const size_t report_${name}_size = sizeof report_${name};\n")
endforeach()
file(WRITE ${INTO} "${text}")

# Writes the report's page as C++ text in two halves, before and behind its block of data. The halves contain the style and
# the scripts, and d3 with its licence before the scripts (page/DATA.md describes the assembly).
#
#   cmake -DPAGE=DIR -DD3=FILE -DD3_LICENCE=FILE [-DKERNEL=FILE] -DOUT=FILE -P page_files.cmake
cmake_minimum_required(VERSION 3.25)

file(READ ${PAGE}/index.html html)
set(style "")
file(GLOB sheets ${PAGE}/*.css)
list(SORT sheets)
foreach(sheet IN LISTS sheets)
  file(READ ${sheet} text)
  string(APPEND style "${text}")
endforeach()

file(READ ${D3} d3)
file(READ ${D3_LICENCE} licence)
string(REPLACE "*/" "* /" licence "${licence}")
set(scripts "<script>\n/*\n${licence}*/\n${d3}</script>\n")
file(GLOB files ${PAGE}/*.js)
list(SORT files)
foreach(file IN LISTS files)
  file(READ ${file} text)
  if(text MATCHES "</[sS][cC][rR][iI][pP][tT]")
    message(FATAL_ERROR "${file} holds the text \"</script\": it would end there")
  endif()
  string(APPEND scripts "<script>\n${text}</script>\n")
endforeach()

foreach(marker style scripts data)
  string(FIND "${html}" "<!-- ${marker} -->" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${PAGE}/index.html: found no <!-- ${marker} -->, expected each of style, data and scripts")
  endif()
endforeach()
if(KERNEL)
  file(READ ${KERNEL} kernel)
  string(PREPEND scripts "<script type=\"application/octet-stream\" id=\"kernel\">${kernel}</script>\n")
endif()
string(REPLACE "<!-- style -->" "<style>\n${style}</style>" html "${html}")
string(REPLACE "<!-- scripts -->" "${scripts}" html "${html}")
string(FIND "${html}" "<!-- data -->" place)
string(SUBSTRING "${html}" 0 ${place} before)
math(EXPR behind "${place} + 13") # the marker's length
string(SUBSTRING "${html}" ${behind} -1 after)

file(CONFIGURE OUTPUT ${OUT} @ONLY NEWLINE_STYLE UNIX CONTENT [[
// Made by page_files.cmake.
#include "montecarlo/report/page/page_files.hpp"
namespace wingspread {
const std::string_view page_before_data = R"page~file(@before@)page~file";
const std::string_view page_after_data = R"page~file(@after@)page~file";
} // namespace wingspread
]])

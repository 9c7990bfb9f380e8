# Writes build_stamp.hpp, which names the commit that the program is built from. Runs at each build, not only when CMake
# configures. The stamp is `+gCOMMIT`, followed by `.dirty` if files differ from the commit; it is empty outside a
# repository (an archive of the sources). An unchanged file is not written again, so that nothing is rebuilt.
#
#   cmake -DSOURCE=DIR -DOUT=FILE -P build_stamp.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty=.dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-prefix # empty at the top of a repository
                OUTPUT_VARIABLE within OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(stamp "")
if(failed EQUAL 0 AND commit AND NOT within)
  set(stamp "+g${commit}")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define WINGSPREAD_BUILD \"@stamp@\"\n" @ONLY)

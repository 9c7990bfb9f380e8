# Writes build_stamp.hpp: from which commit the program is built, as at the time of the build and not of the
# configuration. `+gCOMMIT`, with `.dirty` behind it where files differ from the commit; nothing where there is no
# repository (an archive of the sources). Left alone while it stays the same, so that nothing is built again.
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

# Has the program print its man pages and completions into OUT.
function(print file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${OUT}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(compress from to)
  execute_process(COMMAND ${GZIP} -9nc ${from} OUTPUT_FILE ${to} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${OUT}/man)
file(MAKE_DIRECTORY ${OUT}/man)
foreach(shell bash zsh fish)
  print(wingspread.${shell} completion ${shell})
endforeach()
print(wingspread.1 man)
compress(${OUT}/wingspread.1 ${OUT}/man/wingspread.1.gz)
file(READ ${OUT}/wingspread.1 page)
string(REGEX MATCHALL "wingspread.-[a-z]+" names "${page}") # those that it lists
list(REMOVE_DUPLICATES names)
foreach(name ${names})
  string(REGEX REPLACE ".*-" "" command ${name})
  print(wingspread-${command}.1 man --of ${command})
  compress(${OUT}/wingspread-${command}.1 ${OUT}/man/wingspread-${command}.1.gz)
endforeach()
foreach(what scene campaign)
  print(${what}.schema.json schema ${what})
endforeach()
compress(${CHANGELOG} ${OUT}/changelog.gz)
# Debian's own, of a package that has no history there.
foreach(name wingspread libwingspread-dev python3-wingspread)
  file(WRITE ${OUT}/changelog
    "${name} (${VERSION}) unstable; urgency=medium\n\n  * What has changed is in changelog.gz.\n\n"
    " -- ${MAINTAINER}  Thu, 01 Jan 2026 00:00:00 +0000\n")
  compress(${OUT}/changelog ${OUT}/${name}.changelog.gz)
endforeach()
file(TOUCH ${OUT}/made)

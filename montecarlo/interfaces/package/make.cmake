# Makes in OUT the man pages (with HELP2MAN), the JSON Schemas and the compressed changelogs.
file(REMOVE_RECURSE ${OUT}/man)
file(MAKE_DIRECTORY ${OUT}/man)

function(compress from to)
  execute_process(COMMAND ${GZIP} -9nc ${from} OUTPUT_FILE ${to} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The man page of a command, or of the program for an empty command.
# help2man takes the page's name from the name of the file that it calls, and keeps lines that begin with "$ " as they are. The
# name goes through a shell: here it has no path, which may have blanks. Lines of JSON are kept too, unfilled, without the
# mark "$ @" that they are given for this.
function(make_man_page command)
  set(name wingspread)
  if(command)
    string(APPEND name -${command})
  endif()
  file(WRITE ${OUT}/man/${name} "#!/bin/sh
'${PROGRAM}' ${command} \"$@\" | sed 's/^Example:/Examples:/; s/^  wingspread/  $ wingspread/; s/^  \\( *\\({\\|\"[a-z_]*\":\\)\\)/  $ @\\1/'\n")
  file(CHMOD ${OUT}/man/${name} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  execute_process(COMMAND ${PROGRAM} ${command} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "^(Wingspread: )?([^\n]*[^.\n])\\.?\n.*" "\\2" brief "${help}")
  # SOURCE_DATE_EPOCH: the page shows its month; the same source gives the same bytes
  execute_process(COMMAND ${CMAKE_COMMAND} -E env SOURCE_DATE_EPOCH=1767225600 LC_ALL=C.UTF-8
    ${HELP2MAN} --locale=C.UTF-8 --no-info --version-string=${version} "--name=${brief}" --output=${OUT}/man/${name}.1
    ./${name} WORKING_DIRECTORY ${OUT}/man COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND sed -i -e "/^\\\\f(CW\\$ @/{s/-/\\\\-/g; s/^\\\\f(CW\\$ @\\(.*\\)$/.nf\\n\\\\f(CW\\1\\n.fi/}" ${OUT}/man/${name}.1
    COMMAND_ERROR_IS_FATAL ANY)
  compress(${OUT}/man/${name}.1 ${OUT}/man/${name}.1.gz)
  file(REMOVE ${OUT}/man/${name} ${OUT}/man/${name}.1)
endfunction()

if(HELP2MAN)
  string(REGEX REPLACE "-.*" "" version ${VERSION})
  make_man_page("")
  execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "\nSubcommands:(\n  [^\n]*)+" list "${help}")
  string(REGEX MATCHALL "\n  [a-z]+" commands "${list}")
  foreach(command ${commands})
    string(STRIP ${command} command)
    make_man_page(${command})
  endforeach()
endif()
foreach(what scene campaign)
  execute_process(COMMAND ${PROGRAM} schema ${what} OUTPUT_FILE ${OUT}/${what}.schema.json COMMAND_ERROR_IS_FATAL ANY)
endforeach()
compress(${CHANGELOG} ${OUT}/changelog.gz)
# Debian asks for a changelog of its own; this package has no history there.
foreach(name wingspread libwingspread-dev python3-wingspread)
  file(WRITE ${OUT}/changelog
    "${name} (${VERSION}) unstable; urgency=medium\n\n  * What has changed is in changelog.gz.\n\n"
    " -- ${MAINTAINER}  Thu, 01 Jan 2026 00:00:00 +0000\n")
  compress(${OUT}/changelog ${OUT}/${name}.changelog.gz)
endforeach()
file(TOUCH ${OUT}/made)

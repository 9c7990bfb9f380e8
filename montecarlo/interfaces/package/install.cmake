# Files of a package beside the program and the library: man pages, completions, JSON Schemas, the scenes and campaigns
# as examples, changelogs and licences.
include(GNUInstallDirs)
set(made ${PROJECT_BINARY_DIR}/package)
find_program(WINGSPREAD_GZIP gzip)
find_program(WINGSPREAD_HELP2MAN help2man)
# A build for one kind of processor stops with an illegal instruction on older ones. Its packages are named for it, and the
# tilde lets the package for any x86-64 replace them.
set(WINGSPREAD_REVISION 1)
if(WINGSPREAD_ARCH)
  string(REGEX REPLACE "[^A-Za-z0-9]" "." arch ${WINGSPREAD_ARCH})
  string(APPEND WINGSPREAD_REVISION "~${arch}")
endif()
set(WINGSPREAD_REVISION ${WINGSPREAD_REVISION} PARENT_SCOPE) # for cpack.cmake
set(WINGSPREAD_MAINTAINER "The wingspread authors <wingspread@localhost>" CACHE STRING "Who makes the packages")

if(WINGSPREAD_GZIP AND NOT CMAKE_CROSSCOMPILING AND NOT WINGSPREAD_SANITIZE AND NOT WINGSPREAD_MPI)
  if(NOT WINGSPREAD_HELP2MAN)
    message(STATUS "The man pages are left out: help2man is missing (Debian: help2man)")
  endif()
  add_custom_command(OUTPUT ${made}/made COMMENT "Man pages and schemas" VERBATIM
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:wingspread> -DOUT=${made} -DGZIP=${WINGSPREAD_GZIP}
            -DHELP2MAN=${WINGSPREAD_HELP2MAN}
            -DCHANGELOG=${PROJECT_SOURCE_DIR}/CHANGELOG.md -DVERSION=${PROJECT_VERSION}-${WINGSPREAD_REVISION}
            -DMAINTAINER=${WINGSPREAD_MAINTAINER} -P ${CMAKE_CURRENT_LIST_DIR}/make.cmake
    DEPENDS wingspread ${CMAKE_CURRENT_LIST_DIR}/make.cmake ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
  add_custom_target(wingspread_package_files ALL DEPENDS ${made}/made)
  install(DIRECTORY ${made}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${made}/scene.schema.json ${made}/campaign.schema.json DESTINATION share/wingspread COMPONENT program)
  foreach(package "program wingspread" "development libwingspread-dev" "python python3-wingspread")
    separate_arguments(package)
    list(POP_FRONT package component name)
    install(FILES ${made}/changelog.gz DESTINATION share/doc/${name} COMPONENT ${component})
    install(FILES ${made}/${name}.changelog.gz DESTINATION share/doc/${name} RENAME changelog.Debian.gz
      COMPONENT ${component})
  endforeach()
endif()

set(package ${CMAKE_CURRENT_LIST_DIR})
install(FILES ${package}/wingspread.bash DESTINATION share/bash-completion/completions RENAME wingspread COMPONENT program)
install(FILES ${package}/wingspread.zsh DESTINATION share/zsh/vendor-completions RENAME _wingspread COMPONENT program)
install(FILES ${package}/wingspread.fish DESTINATION share/fish/vendor_completions.d COMPONENT program)

# Our licence, and those of what is compiled into the program, as Debian's packages of them state them. Boost's asks for no
# notice in a program.
set(parts nlohmann-json3-dev libcli11-dev libeigen3-dev librandom123-dev)
if(WINGSPREAD_HDF5_FOUND)
  list(APPEND parts libhdf5-dev zlib1g-dev libaec-dev)
endif()
if(kernel) # in the report's page
  list(APPEND parts wasi-libc libc++-14-dev-wasm32 libc++abi-14-dev-wasm32 libclang-rt-14-dev-wasm32)
endif()
list(TRANSFORM parts REPLACE "(.+)" "/usr/share/doc/\\1/copyright")
set(of_python /usr/share/doc/pybind11-dev/copyright)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE rights)
string(PREPEND rights "wingspread\n\n")
string(APPEND rights "\nThe program holds code of the following, and the report's page d3.\n")
set(WINGSPREAD_UNLICENSED "") # for cpack.cmake: no package without the notices that it owes
foreach(file ${WINGSPREAD_D3_LICENCE} ${parts} ${of_python})
  set(text "")
  if(EXISTS ${file})
    file(READ ${file} text)
    string(PREPEND text "\n----------------------------------------------------------------\n${file}\n\n")
  else()
    list(APPEND WINGSPREAD_UNLICENSED ${file})
  endif()
  if(file STREQUAL of_python)
    file(GENERATE OUTPUT ${made}/copyright.python CONTENT "${rights}${text}")
  else()
    string(APPEND rights "${text}")
  endif()
endforeach()
set(WINGSPREAD_UNLICENSED "${WINGSPREAD_UNLICENSED}" CACHE INTERNAL "Notices that a package would lack")
file(GENERATE OUTPUT ${made}/copyright CONTENT "${rights}")
install(FILES ${made}/copyright DESTINATION share/doc/wingspread COMPONENT program)
install(FILES ${made}/copyright DESTINATION share/doc/libwingspread-dev COMPONENT development)
install(FILES ${made}/copyright.python DESTINATION share/doc/python3-wingspread RENAME copyright COMPONENT python)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/studies/scenes ${PROJECT_SOURCE_DIR}/studies/campaigns
  DESTINATION share/wingspread/examples COMPONENT program FILES_MATCHING PATTERN *.json PATTERN *.csv)

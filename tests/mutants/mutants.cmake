# For mutants.py: libraries with faults are compiled quickly.
function(compile_quickly)
  foreach(target IN LISTS WINGSPREAD_CHANGED)
    if(TARGET ${target})
      target_compile_options(${target} PRIVATE -O1)
    endif()
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY ${CMAKE_SOURCE_DIR} CALL compile_quickly)

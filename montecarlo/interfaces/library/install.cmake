# The library for other programs: libwingspread.a (core, distributions and montecarlo), its headers and its CMake package.
# It passes no compiler flags on.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Copies of the public headers that include each other as <wingspread/NAME>.
set(public_include ${PROJECT_BINARY_DIR}/include)
foreach(header interfaces/library/wingspread.hpp foundation/formats/spec_error.hpp foundation/formats/machine_error.hpp
        foundation/platform/stopped.hpp)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${header})
  cmake_path(GET header FILENAME name)
  file(READ ${header} text)
  string(REGEX REPLACE "#include \"montecarlo/foundation/[a-z]+/([a-z_]+\\.hpp)\"" "#include <wingspread/\\1>" text "${text}")
  file(CONFIGURE OUTPUT ${public_include}/wingspread/${name} CONTENT "${text}" @ONLY)
endforeach()

add_library(wingspread_library STATIC
  $<TARGET_OBJECTS:wingspread_core> $<TARGET_OBJECTS:wingspread_distributions> $<TARGET_OBJECTS:wingspread_montecarlo>
  $<TARGET_OBJECTS:wingspread_montecarlo_cold>)
# core/CMakeLists.txt links the objects of its instruction sets itself, so TARGET_OBJECTS leaves them out.
get_target_property(core_sources wingspread_core SOURCES)
list(FILTER core_sources INCLUDE REGEX "\\.o$")
target_sources(wingspread_library PRIVATE ${core_sources})
set_source_files_properties(${core_sources} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
add_dependencies(wingspread_library wingspread_core)
set_target_properties(wingspread_library PROPERTIES OUTPUT_NAME wingspread EXPORT_NAME wingspread LINKER_LANGUAGE CXX)
target_compile_features(wingspread_library INTERFACE cxx_std_20)
target_include_directories(wingspread_library INTERFACE
  $<BUILD_INTERFACE:${public_include}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(wingspread_library PRIVATE OpenMP::OpenMP_CXX fmt::fmt)
add_library(wingspread::wingspread ALIAS wingspread_library)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/wingspread)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/wingspreadConfig.cmake.in ${PROJECT_BINARY_DIR}/wingspreadConfig.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/wingspreadConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(TARGETS wingspread_library EXPORT wingspreadTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(DIRECTORY ${public_include}/wingspread DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT wingspreadTargets NAMESPACE wingspread:: DESTINATION ${package} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/wingspreadConfig.cmake ${PROJECT_BINARY_DIR}/wingspreadConfigVersion.cmake
  DESTINATION ${package} COMPONENT development)

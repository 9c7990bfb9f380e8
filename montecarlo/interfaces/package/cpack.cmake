# Debian packages: the program, the library, the Python module. `cpack --preset portable` makes packages that run on any
# x86-64 processor. CPack derives their dependencies from the files.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME wingspread)
set(CPACK_PACKAGE_CONTACT ${WINGSPREAD_MAINTAINER})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE ${WINGSPREAD_REVISION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL program development)
if(WINGSPREAD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME wingspread)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# A summary would be the synopsis of all packages. CPack indents the lines of a description.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Monte Carlo deployment of spacecraft solar wings
How far the deployment of a spacecraft's solar wing may stray from the
drawing: rigid panels, hinges with springs, friction, dampers and latches;
a campaign over what varies in them, its statistics, and the requirements
that it has to meet.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libwingspread-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
math(EXPR next "${fmt_VERSION_MAJOR} + 1") # of fmt: its names have the version in them
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libfmt-dev (>= ${fmt_VERSION_MAJOR}), libfmt-dev (<< ${next}~), g++")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Deployment of spacecraft solar wings, the library
What the program wingspread does, for programs in C++: a static library, its
header, and what find_package reads.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-wingspread)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${WINGSPREAD_PYTHON_NEEDS}, python3-numpy")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Deployment of spacecraft solar wings, in Python
What the program wingspread does, with numpy arrays: campaigns, deployments,
and a wing as a function of its parameters.")

set(unlicensed "${WINGSPREAD_UNLICENSED}")
if(NOT WINGSPREAD_PYTHON)
  list(FILTER unlicensed EXCLUDE REGEX pybind11)
endif()
if(unlicensed)
  file(WRITE ${PROJECT_BINARY_DIR}/package/unlicensed.cmake
    "message(FATAL_ERROR \"The packages would lack the licences of code that they hold: ${unlicensed}\")\n")
  set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/package/unlicensed.cmake)
endif()
include(CPack)

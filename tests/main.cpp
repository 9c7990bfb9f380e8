#define CATCH_CONFIG_MAIN
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

const char* const wingspread::source_folder = WINGSPREAD_SOURCE_DIR;

/// Where the repository stands, for tests that read its files.
#pragma once

namespace wingspread {

/// The absolute path of the repository's root. Defined in tests/main.cpp, the one unit that knows the path.
extern const char* const source_folder;

} // namespace wingspread

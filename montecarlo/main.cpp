#include "montecarlo/interfaces/commands/cli.hpp"

int main(int argc, char** argv) { return wingspread::command_line(argc, argv); }

#include "commands.hpp"

int main(int argc, char** argv) { return ayumi::app::run(argc, argv); }

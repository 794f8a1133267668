/// Parameter files, with nothing but what the README names.
#include README_HEADER

int main() { return hammer_loads::loadFiles(hammer_loads::configDirectory(), {}).value ? 0 : 1; }

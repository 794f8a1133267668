/// Loads parameter files using only names from doc/api.md.
#include API_HEADER

int main() { return hammer_loads::loadFiles(hammer_loads::configDirectory(), {}).value ? 0 : 1; }

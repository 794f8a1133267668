/// Parameter files, with nothing but what doc/api.md names.
#include API_HEADER

int main() { return hammer_loads::loadFiles(hammer_loads::configDirectory(), {}).value ? 0 : 1; }

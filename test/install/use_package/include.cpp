/// A header that needs no other before it.
#include API_HEADER

int main() { return 0; }

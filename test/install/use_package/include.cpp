/// Includes a header that needs no other header before it.
#include API_HEADER

int main() { return 0; }

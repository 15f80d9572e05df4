// A fault that check_symbols.sh must find.
int* allocate() {
  return new int(3);
}

// A fault that check_symbols.sh must find.
void refuse(int number) {
  if (number < 0) throw number;
}

// A fault that check_symbols.sh must find.
#include <iostream>
void tell(int number) {
  std::cout << number;
}

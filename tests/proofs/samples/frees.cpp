// A fault that check_symbols.sh must find.
#include <cstdlib>
void give_back(void* block) {
  std::free(block);
}

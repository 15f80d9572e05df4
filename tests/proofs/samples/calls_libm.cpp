// A fault that check_symbols.sh must find: not the same bits everywhere.
#include <cmath>
double turn(double angle) {
  return std::sin(angle);
}

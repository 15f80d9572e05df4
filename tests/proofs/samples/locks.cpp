// A fault that check_symbols.sh must find.
#include <mutex>
void hold(std::mutex& mutex) {
  mutex.lock();
}

// A fault that check_headers.sh must find.
#pragma once
#include <vector>

// What most tests begin with, read once for all of them where the compiler can (SConstruct). No test may lean
// on it: each includes what it uses, and the sanitized build, which has none of this, tells where one does
// not.
#include <gtest/gtest.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

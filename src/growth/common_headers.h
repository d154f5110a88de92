// What most files of growth begin with, as src/common_headers.h.
#include "../common_headers.h"

#include "growth/surface.h"

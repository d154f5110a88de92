// What is wrong with a sketch, for a sentence. Internal to sketch/.
#pragma once

#include <string>

#include "sketch/strokes.h"

namespace treerec {

// What check_sketch() refuses, without the sentence's subject: " has a stroke, number 2, that has no
// points."; empty where all is well.
std::string sketch_fault(const Sketch& sketch);

}  // namespace treerec

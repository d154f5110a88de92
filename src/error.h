// The one exception type of the library, and the one for a cancelled job.
#pragma once

#include <stdexcept>
#include <string>

namespace treerec {

// A sentence for the user: what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}
};

// Thrown out of a long job after its Progress said that the user cancelled it.
class Cancelled : public Error {
  public:
    Cancelled() : Error("Cancelled.") {}
};

}  // namespace treerec

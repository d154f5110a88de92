// The one exception type of the library, and the one for a cancelled job.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace treerec {

// A sentence for the user: what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}
};

// What a file says, in quotes for a sentence: its first 40 characters, without what a terminal would obey.
inline std::string quote_word(std::string_view word) {
    std::string text = "'";
    for (const char c : word.substr(0, 40))
        text += c >= ' ' && c <= '~' ? c : '?';
    return text + "'";
}

// Thrown out of a long job after its Progress said that the user cancelled it.
class Cancelled : public Error {
  public:
    Cancelled() : Error("Cancelled.") {}
};

}  // namespace treerec

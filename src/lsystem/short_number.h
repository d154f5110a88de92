// Decimals that are as short as an error bound allows.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace treerec {

// Appends the shortest decimal that reads back as the same double.
inline void append_exact(std::string& out, double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    out.append(buffer, result.ptr);
}

// A decimal within `tolerance` of `value`, with as few places behind the point as that takes: `rounded` is
// what a reader makes of it.
class ShortNumber {
  public:
    ShortNumber(double value, double tolerance) : rounded(value) {
        double power = 1.0;
        for (places_ = 0; places_ <= 15; places_++, power *= 10.0) {
            const double scaled = value * power;
            if (!(std::abs(scaled) < 1e15)) break;
            digits_ = std::llround(scaled);
            // A quotient of two exact doubles is the double nearest to the decimal, as a reader has it.
            const double candidate = static_cast<double>(digits_) / power;
            if (std::abs(candidate - value) > tolerance) continue;
            rounded = candidate;
            return;
        }
        places_ = -1;
    }

    void append(std::string& out) const {
        if (places_ < 0) return append_exact(out, rounded);
        char buffer[24];
        const int64_t whole = digits_ < 0 ? -digits_ : digits_;
        const auto result = std::to_chars(buffer, buffer + sizeof buffer, whole);
        const int count = static_cast<int>(result.ptr - buffer);
        if (digits_ < 0) out += '-';
        if (places_ == 0) {
            out.append(buffer, result.ptr);
            return;
        }
        const int before = count - places_;
        if (before > 0)
            out.append(buffer, static_cast<size_t>(before));
        else
            out += '0';
        out += '.';
        for (int i = before; i < 0; i++)
            out += '0';
        out.append(buffer + (before > 0 ? before : 0), result.ptr);
    }

    // Without its sign.
    ShortNumber magnitude() const {
        ShortNumber result = *this;
        result.rounded = std::abs(rounded);
        result.digits_ = digits_ < 0 ? -digits_ : digits_;
        return result;
    }

    double rounded;

  private:
    int places_ = 0;  // behind the point; -1 for the double itself
    int64_t digits_ = 0;
};

}  // namespace treerec

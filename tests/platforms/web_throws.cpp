// A module that throws and catches, as the library does, for a program that does neither.
#include <stdexcept>

extern "C" __attribute__((used, visibility("default"))) int web_throws(int thrown) {
    try {
        if (thrown) throw std::runtime_error("thrown");
    } catch (const std::exception& error) {
        return error.what()[0];
    }
    return 0;
}

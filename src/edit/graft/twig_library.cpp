#include "edit/graft/twig_library.h"

#include <string>

#include "error.h"

namespace treerec {

const LibraryTwig& find_library_twig(std::string_view name) {
    std::string names;
    for (const LibraryTwig& twig : twig_library()) {
        if (twig.name == name) return twig;
        names += (names.empty() ? "" : ", ") + std::string(twig.name);
    }
    throw Error("The library has no twig called " + quote_word(name) + "; it has " + names + ".");
}

}  // namespace treerec

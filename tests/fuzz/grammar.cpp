#include "lsystem/grammar.h"

#include "fuzz.h"

using namespace treerec;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    is_grammar(text);
    try {
        const Grammar grammar = Grammar::parse(text);
        fuzz::require(is_grammar(text), "what has an axiom is a grammar");
        RewriteOptions options;
        options.iterations = std::min(grammar.iterations, 50);
        options.most_symbols = 20000;
        options.most_bytes = 4 << 20;
        options.most_seconds = 2.0;
        const std::string string = rewrite(grammar, options);
        fuzz::require(read_lstring(string, grammar.turtle).check() == std::nullopt, "a tree is sound");
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}

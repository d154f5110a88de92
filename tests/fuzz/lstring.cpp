#include "lsystem/lstring.h"

#include "exchange/lstring_file.h"
#include "fuzz.h"

using namespace treerec;

// What is read can be written, and read again with as many nodes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const LStringDialect dialect : {LStringDialect::kTurtle, LStringDialect::kPaper}) {
        LStringOptions options;
        options.dialect = dialect;
        try {
            const LStringTree read = parse_lstring_file(text, "a file", options);
            fuzz::require(read.tree.check() == std::nullopt, "a tree that was read is sound");
            for (const LStringLeaf& leaf : read.leaves)
                fuzz::require(read.tree.contains(leaf.node), "a leaf has a node");
            const std::string written = write_lstring(read.tree, read.tree.root(), options);
            fuzz::require(read_lstring(written, options).size() == read.tree.size(),
                          "a tree that was written is read again");
        } catch (const Error& error) {
            fuzz::require_sentence(error);
        }
    }
    return 0;
}

#include <chrono>
#include <cstdio>
#include <functional>

#include "bench.h"
#include "error.h"
#include "geometry/random.h"
#include "lsystem/grammar.h"
#include "lsystem/lstring.h"

namespace treerec::bench {

namespace {

constexpr size_t kBytes = 10'000'000;

// A tree that winds and forks without end, as many nodes as its string needs for kBytes.
Tree winding_tree(size_t nodes) {
    Random random(1);
    std::vector<NodeId> parents{kNoNode};
    std::vector<DVec3> positions{DVec3(0.0)};
    std::vector<double> radii{0.5};
    std::vector<NodeId> tips{0};
    while (parents.size() < nodes) {
        const size_t which = random.below(static_cast<uint32_t>(tips.size()));
        const NodeId at = tips[which];
        parents.push_back(at);
        positions.push_back(positions[static_cast<size_t>(at)] +
                            random.uniform(0.02, 0.4) * (random.direction() + DVec3(0.0, 0.5, 0.0)));
        radii.push_back(radii[static_cast<size_t>(at)] * random.uniform(0.95, 1.0));
        const NodeId made = static_cast<NodeId>(parents.size()) - 1;
        if (tips.size() < 3000 && random.below(3) == 0)
            tips.push_back(made);
        else
            tips[which] = made;
    }
    return Tree::from_arrays(parents, positions, radii, std::vector<uint8_t>(parents.size(), 0));
}

double fastest_ms(int repetitions, const std::function<void()>& work) {
    double best = 1e300;
    for (int i = 0; i < repetitions; i++) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        best = std::min(best, taken.count());
    }
    return best;
}

void print_row(const char* stage, size_t bytes, size_t count, double ms) {
    std::printf("%-28s %9.2f %10zu %10.1f %10.1f %10.0f\n", stage, 1e-6 * static_cast<double>(bytes), count,
                ms, 1e-3 * static_cast<double>(bytes) / ms, 1e6 * ms / static_cast<double>(count));
}

}  // namespace

void bench_strings(const Settings& settings) {
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 5;
    const Tree tree = winding_tree(kBytes / 40);
    std::string string = write_lstring(tree, tree.root());
    std::printf("L-strings: fastest of %d runs, 1 thread\n", repetitions);
    std::printf("%-28s %9s %10s %10s %10s %10s\n", "stage", "MB", "nodes", "ms", "MB/s", "ns/node");
    print_row("tree to string", string.size(), tree.size(),
              fastest_ms(repetitions, [&] { string = write_lstring(tree, tree.root()); }));
    size_t nodes = 0;
    const double reading = fastest_ms(repetitions, [&] { nodes = read_lstring(string).size(); });
    if (nodes != tree.size()) throw Error("The string lost nodes.");
    print_row("string to tree", string.size(), nodes, reading);

    LStringOptions paper;
    paper.dialect = LStringDialect::kPaper;
    const std::string absolute = write_lstring(tree, tree.root(), paper);
    print_row("the paper's string to tree", absolute.size(), nodes,
              fastest_ms(repetitions, [&] { nodes = read_lstring(absolute, paper).size(); }));

    Grammar grammar = Grammar::parse(grammar_preset("monopodial"));
    RewriteOptions options;
    options.iterations = 17;
    const double rewriting = fastest_ms(repetitions, [&] { string = rewrite(grammar, options); });
    nodes = read_lstring(string).size();
    print_row("grammar to string", string.size(), nodes, rewriting);
    print_row("its string to tree", string.size(), nodes,
              fastest_ms(repetitions, [&] { nodes = read_lstring(string).size(); }));
}

}  // namespace treerec::bench

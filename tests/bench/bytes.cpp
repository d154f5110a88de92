// Table 9.2 of Zhang 2013 on real scans: bytes of the cloud, of its skeleton, and of lighter ones.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "bench.h"
#include "child.h"
#include "edit/lighten/lighten.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "pipeline/reconstruct.h"

namespace treerec::bench {

namespace {

double kilobytes_of(const std::string& file) {
    return static_cast<double>(std::filesystem::file_size(path_of(file))) / 1024.0;
}

double kilobytes_of(const Tree& tree, const ScratchFolder& folder) {
    const std::string file = folder.file("tree.txt");
    write_treefile(file, tree);
    return kilobytes_of(file);
}

Tree with_share(Tree tree, double share) {
    LightenOptions options;
    options.nodes =
        std::max<size_t>(2, static_cast<size_t>(std::lround(share * static_cast<double>(tree.size()))));
    lighten(tree, options);
    return tree;
}

}  // namespace

void bench_bytes(const std::vector<std::string>& scans) {
    const ScratchFolder folder;
    const LightenOptions merging;
    std::printf("%-36s %9s %12s %10s %9s %11s\n", "scan", "cloud MB", "skeleton KB", "merged KB", "half KB",
                "quarter KB");
    for (const std::string& scan : scans) {
        const std::string name = utf8_of(path_of(scan).filename());
        try {
            const Tree tree = reconstruct_file(scan, {}).tree;
            Tree merged = tree;
            merge_branches(merged, merging.angle, merging.distance);
            std::printf("%-36s %9.2f %12.1f %10.1f %9.1f %11.1f\n", name.c_str(), kilobytes_of(scan) / 1024.0,
                        kilobytes_of(tree, folder), kilobytes_of(merged, folder),
                        kilobytes_of(with_share(tree, 0.5), folder),
                        kilobytes_of(with_share(tree, 0.25), folder));
        } catch (const Error& error) {
            std::printf("%-36s %s\n", name.c_str(), error.what());
        }
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench

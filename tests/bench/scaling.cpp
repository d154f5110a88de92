#include <cstdio>
#include <filesystem>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bench.h"
#include "child.h"
#include "error.h"
#include "geometry/random.h"
#include "scan/formats/read_cloud.h"

namespace treerec::bench {

namespace {

constexpr double kJitter = 0.05;  // metres: standard deviation along every axis

// `count` points: a random part of the scan, or copies of it, each point moved a little.
PointCloud resized(const PointCloud& scan, size_t count) {
    PointCloud cloud;
    cloud.frame = scan.frame;
    cloud.positions.reserve(count);
    Random random(1, count);
    if (count <= scan.size()) {
        std::vector<Vec3> rest = scan.positions;
        for (size_t i = 0; i < count; i++) {
            std::swap(rest[i], rest[i + random.below(static_cast<uint32_t>(rest.size() - i))]);
            cloud.positions.push_back(rest[i]);
        }
        return cloud;
    }
    for (size_t i = 0; i < count; i++) {
        DVec3 p(scan.positions[i % scan.size()]);
        if (i >= scan.size()) p += kJitter * DVec3(random.normal(), random.normal(), random.normal());
        cloud.positions.emplace_back(p);
    }
    return cloud;
}

}  // namespace

void write_resized(const std::string& scan, size_t count, const std::string& path) {
    if (count < 10) throw Error("A cloud needs at least 10 points.");
    write_cloud(path, resized(read_cloud(scan), count));
}

void bench_scaling(const std::string& scan, const Settings& settings) {
    const ScratchFolder folder;
    const std::string cloud = folder.file("cloud.ply"), out = folder.file("tree.glb");
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 1;
    std::printf("\n%s, thinned out or copied with 5 cm jitter; whole runs, PLY to GLB\n",
                std::filesystem::path(scan).filename().string().c_str());
    std::printf("%10s %9s %9s %9s %12s %9s\n", "points", "wall s", "CPU s", "1 core s", "us/point",
                "peak MB");
    for (size_t count : {10'000, 100'000, 1'000'000, 2'000'000, 10'000'000}) {
        if (count > settings.most_points) break;
        write_resized(scan, count, cloud);
#ifdef __GLIBC__
        malloc_trim(0);  // what this process holds counts as the child's peak
#endif
        std::vector<double> walls, cpus, alone, peaks;
        for (int i = 0; i < repetitions; i++) {
            const std::vector<std::string> words = {settings.program, "reconstruct", cloud, "-o", out,
                                                    "--quiet"};
            for (bool one_core : {false, true}) {
                const ChildRun run = run_child(words, one_core);
                if (run.exit_code != 0) throw Error("treerec failed:\n" + run.output);
                (one_core ? alone : walls).push_back(run.wall_s);
                if (one_core) continue;
                cpus.push_back(run.cpu_s);
                peaks.push_back(run.peak_mb);
            }
        }
        std::printf("%10zu %9.2f %9.2f %9.2f %12.2f %9.0f\n", count, median(walls), median(cpus),
                    median(alone), 1e6 * median(cpus) / static_cast<double>(count), median(peaks));
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench

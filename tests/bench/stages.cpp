#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <thread>

#include "bench.h"
#include "child.h"
#include "geometry/parallel.h"
#include "memory.h"
#include "pipeline/export.h"
#include "pipeline/reconstruct.h"
#include "skeleton/sampling/thin.h"

namespace treerec::bench {

namespace {

struct Round {
    std::vector<StageTime> stages;
    std::vector<double> cpu_ms;     // per stage, of all threads
    std::vector<MemoryUse> memory;  // per stage; none where it was not counted
    size_t points_read = 0;
    double total() const {
        double sum = 0.0;
        for (const StageTime& stage : stages)
            sum += stage.milliseconds;
        return sum;
    }
};

// What the stages' observer writes to.
struct StageLog {
    Round* round = nullptr;
    bool memory = false;
    std::clock_t last = 0;
} stage_log;

void log_stage(const StageTime&) {
    const std::clock_t now = std::clock();
    stage_log.round->cpu_ms.push_back(1000.0 * static_cast<double>(now - stage_log.last) / CLOCKS_PER_SEC);
    stage_log.last = now;
    if (stage_log.memory) stage_log.round->memory.push_back(take_memory_use());
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

// From the file to a GLB file. thinned: gets the coordinates that a triangulation would see.
Round run_once(const std::string& scan, const std::string& out, bool memory,
               std::vector<float>* thinned = nullptr) {
    Round round;
    count_memory(memory);
    StageClock::observer = log_stage;
    stage_log = {&round, memory, std::clock()};
    {
        Reconstruction result = reconstruct_file(scan, {});
        round.points_read = result.points_read;
        round.stages = result.stages;
        StageClock clock(round.stages);
        TreeExporter exporter(result.tree, {});
        exporter.write(out);
        clock.stop("Write GLB", exporter.triangles());
        if (thinned) {
            SubProgress silent(nullptr, 0.0, 1.0);
            for (const Vec3& p : thin_points(result.cloud.positions, result.spacing, silent))
                thinned->insert(thinned->end(), {p.x, p.y, p.z});
        }
    }
    StageClock::observer = nullptr;
    count_memory(false);
    return round;
}

// The fastest time of every stage.
Round fastest(const std::string& scan, const std::string& out, int threads, int repetitions) {
    set_thread_count(threads);
    Round best = run_once(scan, out, false);
    for (int i = 1; i < repetitions; i++) {
        const Round next = run_once(scan, out, false);
        for (size_t k = 0; k < best.stages.size(); k++) {
            best.stages[k].milliseconds = std::min(best.stages[k].milliseconds, next.stages[k].milliseconds);
            best.cpu_ms[k] = std::min(best.cpu_ms[k], next.cpu_ms[k]);
        }
    }
    set_thread_count(0);
    return best;
}

}  // namespace

void bench_stages(const std::string& scan, const Settings& settings) {
    const ScratchFolder folder;
    const std::string out = folder.file("tree.glb");
    std::vector<float> thinned;
    set_thread_count(1);
    const Round memory = run_once(scan, out, true, &thinned);
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 3;
    const int threads = std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
    const Round one = fastest(scan, out, 1, repetitions);
    const Round many = fastest(scan, out, threads, repetitions);

    const double points = static_cast<double>(one.points_read);
    std::printf("\n%s: %zu points; fastest of %d runs in one process; CPU, ns and MB on 1 thread\n",
                std::filesystem::path(scan).filename().string().c_str(), one.points_read, repetitions);
    std::printf("%-18s %9s %10s %10s %7s%-3d %9s %12s %9s\n", "stage", "count", "CPU ms", "ms, 1 thr.",
                "ms, ", threads, "ns/point", "allocated", "held MB");
    for (size_t i = 0; i < one.stages.size(); i++) {
        const StageTime& stage = one.stages[i];
        std::printf("%-18s %9zu %10.1f %10.1f %10.1f %9.0f %9.1f MB %9.1f\n", stage.name.c_str(), stage.count,
                    one.cpu_ms[i], stage.milliseconds, many.stages[i].milliseconds,
                    1e6 * one.cpu_ms[i] / points, memory.memory[i].allocated_mb, memory.memory[i].peak_mb);
    }
    double peak = 0.0, allocated = 0.0;
    for (const MemoryUse& use : memory.memory) {
        peak = std::max(peak, use.peak_mb);
        allocated += use.allocated_mb;
    }
    std::printf("%-18s %9s %10.1f %10.1f %10.1f %9.0f %9.1f MB %9.1f\n", "file to GLB", "",
                sum_of(one.cpu_ms), one.total(), many.total(), 1e6 * sum_of(one.cpu_ms) / points, allocated,
                peak);
    const size_t kept = thinned.size() / 3;
    double floor = delaunay_floor_ms(thinned);
    for (int i = 1; i < repetitions; i++)
        floor = std::min(floor, delaunay_floor_ms(thinned));
    std::printf(
        "%-18s %9zu %10.1f %10s %10s %9.0f   CGAL's bare Delaunay of the thinned points, to compare\n",
        "(floor)", kept, floor, "", "", 1e6 * floor / points);
}

}  // namespace treerec::bench

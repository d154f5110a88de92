#include <cstdio>
#include <filesystem>

#include "bench.h"
#include "child.h"
#include "error.h"
#include "file_bytes.h"
#include "scan/formats/read_cloud.h"

namespace treerec::bench {

namespace {

struct Runs {
    std::vector<double> wall, cpu, peak;

    void add(const ChildRun& run) {
        wall.push_back(run.wall_s);
        cpu.push_back(run.cpu_s);
        peak.push_back(run.peak_mb);
    }
};

}  // namespace

// The other program is called as PROGRAM SCAN FOLDER ARGUMENTS…, once per repetition and in turns with ours,
// so that both meet the same weather. Ours runs on all processors, and held to one.
void bench_beside(const std::vector<std::string>& scans, const Settings& settings) {
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 5;
    std::printf("%d whole runs each, in turns; medians; files to GLB for ours\n", repetitions);
    std::printf("%-34s %8s | %8s %8s %6s | %8s %8s %8s %6s | %7s %7s %7s\n", "scan", "points", "theirs s",
                "CPU s", "MB", "ours s", "1 core", "CPU s", "MB", "ratio", "1 core", "CPU");
    std::fflush(stdout);
    for (const std::string& scan : scans) {
        const ScratchFolder folder;
        // One format that both read, with the same digits.
        const std::string text = folder.file(stem_of(scan) + ".xyz");
        size_t points = 0;
        {
            PointCloud cloud = read_cloud(scan);
            points = cloud.size();
            cloud.colors.clear();
            cloud.normals.clear();
            write_cloud(text, cloud);
        }
        const std::string out = folder.file("out");
        std::vector<std::string> theirs_words = {settings.beside, text, out};
        theirs_words.insert(theirs_words.end(), settings.args.begin(), settings.args.end());
        const std::vector<std::string> ours_words = {settings.program,        "reconstruct", text, "-o",
                                                     folder.file("tree.glb"), "--quiet"};
        Runs theirs, ours, alone;
        for (int i = 0; i < repetitions; i++) {
            std::filesystem::remove_all(path_of(out));
            theirs.add(run_child(theirs_words));
            if (!std::filesystem::exists(path_of(out)) || std::filesystem::is_empty(path_of(out)))
                throw Error("'" + settings.beside +
                            "' wrote nothing into the folder that is its second argument.");
            for (Runs* runs : {&ours, &alone}) {
                // Neither takes the place of a file that was there.
                std::filesystem::remove(path_of(folder.file("tree.glb")));
                const ChildRun run = run_child(ours_words, runs == &alone);
                if (run.exit_code != 0) throw Error("treerec failed:\n" + run.output);
                runs->add(run);
            }
        }
        std::printf("%-34s %8zu | %8.3f %8.3f %6.0f | %8.3f %8.3f %8.3f %6.0f | %6.1fx %6.1fx %6.1fx\n",
                    stem_of(scan).c_str(), points, median(theirs.wall), median(theirs.cpu),
                    median(theirs.peak), median(ours.wall), median(alone.wall), median(ours.cpu),
                    median(ours.peak), median(theirs.wall) / median(ours.wall),
                    median(theirs.wall) / median(alone.wall), median(theirs.cpu) / median(ours.cpu));
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench

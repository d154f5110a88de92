// What each way to match photos gives: matches, photos placed, points, error, time.
#include <cstdio>
#include <filesystem>

#include "bench.h"
#include "child.h"
#include "error.h"
#include "file_bytes.h"
#include "photos/cameras_tell.h"
#include "photos/colmap_model.h"
#include "photos/photo_folder.h"
#include "photos/sparse_points.h"
#include "photos/sqlite_tables.h"

namespace treerec::bench {

namespace {

// Rows of all pairs in one of the tables of COLMAP's matches.
double rows_in(const SqliteTables& database, const std::string& table) {
    double rows = 0.0;
    database.each_row(table, [&](int64_t, const std::vector<SqliteValue>& values) {
        if (values.size() > 1) rows += static_cast<double>(values[1].integer);
    });
    return rows;
}

}  // namespace

void tell_photos(const std::string& name, const std::string& matcher, const std::string& out, size_t photos,
                 double seconds) {
    const std::string model_folder = out + "/sparse/0";
    const std::vector<SparsePoint> points = read_sparse_points(model_folder);
    const PhotoModel model = read_photo_model(model_folder);
    const SqliteTables database(out + (matcher == "sift" ? "/colmap/matching.db" : "/colmap/tracks.db"));
    const double raw = rows_in(database, "matches"), verified = rows_in(database, "two_view_geometries");
    double error = 0.0, seen = 0.0;
    size_t sure = 0, near = 0;
    std::vector<DVec3> places;
    for (const SparsePoint& point : points) {
        error += point.error / static_cast<double>(points.size());
        seen += static_cast<double>(point.track) / static_cast<double>(points.size());
        sure += point.track >= 3 && point.error <= 2.0;
        places.push_back(point.position);
    }
    const auto subject = subject_of(model);
    const auto sky = sky_of(model, places);
    std::string on_tree = "-";
    if (subject && sky) {
        // Half as far as the cameras are: the tree, and what stands right beside it.
        const double reach = 0.5 * subject_reach(model, *subject, *sky);
        for (const DVec3& place : places)
            near += away_from_line(place, *subject, *sky) < reach;
        on_tree = std::to_string(near);
    }
    std::printf("| %s | %s | %.0f | %.2f | %zu of %zu | %zu | %zu | %s | %.1f | %.2f | %.0f |\n",
                name.c_str(), matcher.c_str(), raw, raw > 0.0 ? verified / raw : 0.0, model.photos.size(),
                photos, points.size(), sure, on_tree.c_str(), seen, error, seconds);
    std::fflush(stdout);
}

void bench_photos(const std::vector<std::string>& folders, const Settings& settings) {
    if (settings.program.empty()) throw Error("Name the treerec program with --program.");
    std::printf(
        "| photos | matcher | matches | inliers | placed | points | by 3 or more, to 2 px | on the tree | "
        "photos of a "
        "point | error px | s |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& folder : folders) {
        const PhotoFolder photos = list_photos(folder);
        const std::string name = utf8_of(path_of(photos.path).filename());
        for (const char* matcher : {"sift", "pyrlk", "both"}) {
            const ScratchFolder scratch;
            std::vector<std::string> words = {settings.program,    "photos",    folder,   "-o",
                                              scratch.file("out"), "--matcher", matcher,  "--sparse",
                                              "--height",          "1",         "--quiet"};
            words.insert(words.end(), settings.args.begin(), settings.args.end());
            const ChildRun run = run_child(words);
            if (!std::filesystem::exists(path_of(scratch.file("out/sparse/0/images.bin")))) {
                std::printf("| %s | %s | no photo placed: %s |\n", name.c_str(), matcher, run.output.c_str());
                continue;
            }
            tell_photos(name, matcher, scratch.file("out"), photos.photos.size(), run.wall_s);
        }
    }
}

}  // namespace treerec::bench

#include "photos/colmap_work.h"

#include "error.h"

namespace treerec {

namespace {

constexpr size_t kMostExhaustive = 80;  // photos

}  // namespace

Effort effort_of(PhotoEffort effort) {
    switch (effort) {
        case PhotoEffort::kQuick:
            return {1000, 1500};
        case PhotoEffort::kNormal:
            return {1600, 2500};
        case PhotoEffort::kBest:
            break;
    }
    return {3200, 8192};
}

bool ColmapWork::in_sequence() const {
    return options.order == PhotoOrder::kSequence ||
           (options.order == PhotoOrder::kAuto && photos.photos.size() > kMostExhaustive);
}

void ColmapWork::remove_database(const std::string& name) const {
    for (const char* more : {"", "-wal", "-shm", "-journal"}) {
        std::error_code failure;
        std::filesystem::remove(folder / (name + more), failure);
        if (failure) throw Error("'" + at(name) + "' cannot be removed: " + failure.message() + ".");
    }
}

void ColmapWork::set_threads(ColmapCall& call, const OptionNames& names) const {
    if (options.threads > 0) job.set(call.places, call.command, names, std::to_string(options.threads));
}

void ColmapWork::set_one_camera(ColmapCall& call) const {
    job.set(call.settings, call.command, {"--ImageReader.single_camera"}, "1");
    // What one term of distortion leaves over goes into the focal length and so into the size of all that
    // stands nearer than the cameras' circle; many photos of one camera tell two terms.
    job.set(call.settings, call.command, {"--ImageReader.camera_model"}, "RADIAL");
}

ColmapEnd ColmapWork::run_on_either(const ColmapCall& call, const OptionNames& use_gpu,
                                    const std::function<void()>& begin_anew,
                                    const std::function<void(const std::string&)>& on_line) const {
    for (bool gpu = job.colmap().cuda();; gpu = false) {
        ColmapCall whole = call;
        job.set(whole.places, call.command, use_gpu, gpu ? "1" : "0");
        const ColmapEnd end = job.run(whole, on_line);
        if (end.end.well() || !gpu) return end;
        job.note("-- once more, without the graphics card");
        begin_anew();
    }
}

std::string basis_of(const std::string& before, const std::vector<ColmapCall>& calls) {
    std::string basis = before;
    for (const ColmapCall& call : calls) {
        basis += "\n" + call.command;
        for (const std::string& word : call.settings)
            basis += " " + word;
    }
    return basis;
}

}  // namespace treerec

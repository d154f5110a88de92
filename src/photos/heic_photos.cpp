#include "photos/heic_photos.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/child_process.h"
#include "photos/colmap_advice.h"
#include "photos/find_program.h"
#include "photos/folder_lock.h"
#include "photos/photo_folder.h"
#include "photos/run_colmap.h"
#include "photos/run_stage.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

constexpr const char* kMethod = "jpeg 1";  // another number where other pictures come out
constexpr const char* kStage = "HEIC";
constexpr const char* kQuality = "95";  // of 100: no blocks that corners could be found at
constexpr double kMostSeconds = 300.0;  // for one photo
constexpr size_t kMostNamed = 8;        // broken photos, with a warning each

using Words = std::vector<std::string>;

struct Kind {
    const char* name;
    const char* variable;
    Words (*words)(const std::string& from, const std::string& to);
};

// A % begins a pattern in the names that ImageMagick writes to.
std::string without_pattern(const std::string& path) {
    std::string text;
    for (const char c : path)
        text += c == '%' ? "%%" : std::string(1, c);
    return text;
}

Words words_of_libheif(const std::string& from, const std::string& to) {
    return {"-q", kQuality, from, to};
}
Words words_of_sips(const std::string& from, const std::string& to) {
    return {"-s", "format", "jpeg", "-s", "formatOptions", kQuality, from, "--out", to};
}
Words words_of_magick(const std::string& from, const std::string& to) {
    return {from + "[0]", "-quality", kQuality, without_pattern(to)};
}

// The first one that is there is taken.
constexpr Kind kKinds[] = {{"heif-dec", "HEIF_DEC", words_of_libheif},
                           {"heif-convert", "HEIF_CONVERT", words_of_libheif},
                           {"sips", "SIPS", words_of_sips},
                           {"magick", "MAGICK", words_of_magick}};

struct Converter {
    const Kind* kind = nullptr;
    std::string program;
};

std::optional<Converter> find_converter() {
    for (const bool named : {true, false})
        for (const Kind& kind : kKinds) {
            if (named == environment_value(kind.variable).empty()) continue;
            const std::string program = find_program(kind.name, kind.variable);
            if (!program.empty()) return Converter{&kind, program};
        }
    return {};
}

[[noreturn]] void throw_unwritable(const fs::path& path, const std::error_code& failure) {
    throw Error("'" + utf8_of(path) + "' cannot be written: " + failure.message() + ".");
}

// A folder that is empty at first, and goes when its work is done or given up.
struct ScrapFolder {
    fs::path path;
    explicit ScrapFolder(fs::path where) : path(std::move(where)) { clear(); }
    ~ScrapFolder() {
        std::error_code failure;
        fs::remove_all(path, failure);
    }
    void clear() const {
        std::error_code failure;
        fs::remove_all(path, failure);
        make_folder(utf8_of(path));
    }
};

// Whether a JPEG was written to its end.
bool is_whole_jpeg(const fs::path& path) {
    if (size_of_picture(utf8_of(path)).first < 1) return false;
    std::ifstream in(path, std::ios::binary);
    std::array<char, 2> end{};
    return in.seekg(-2, std::ios::end) && in.read(end.data(), 2) && end[0] == '\xFF' && end[1] == '\xD9';
}

// Of what a program made of one file, the picture that is meant: where there are several they are numbered,
// and the first of the largest ones is the photo, the others depths and previews.
std::optional<fs::path> picture_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
        if (extension_of(utf8_of(at->path())) == "jpg" && is_whole_jpeg(at->path()))
            names.push_back(utf8_of(at->path().filename()));
    // -2 before -10.
    std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    std::optional<fs::path> best;
    int64_t most = 0;
    for (const std::string& name : names) {
        const auto [width, height] = size_of_picture(utf8_of(folder / path_of(name)));
        const int64_t pixels = static_cast<int64_t>(width) * height;
        if (pixels > most) best = folder / path_of(name);
        most = std::max(most, pixels);
    }
    return best;
}

class Conversion {
  public:
    Conversion(Converter converter, const fs::path& whole, FolderLock& lock, Progress* progress)
        : converter_(std::move(converter)),
          scrap_(whole / "colmap" / "photo.part"),
          log_(whole / "photos.log", std::ios::binary | std::ios::app),
          lock_(lock),
          progress_(progress) {
        if (!log_) throw Error("'" + utf8_of(whole / "photos.log") + "' cannot be written.");
    }

    // Makes a JPEG at `target`. What is wrong with the photo; "" where it went well.
    std::string convert(const fs::path& source, const fs::path& target) {
        scrap_.clear();
        // Under a plain name: some of these programs take patterns, options and letters of one country only.
        const fs::path from = scrap_.path / path_of("photo." + extension_of(utf8_of(source)));
        const fs::path to = scrap_.path / "photo.jpg";
        std::error_code failure;
        fs::copy_file(source, from, failure);
        if (failure) return said(source, "it cannot be read: " + failure.message());
        ChildCommand command;
        command.program = converter_.program;
        command.arguments = converter_.kind->words(utf8_of(from), utf8_of(to));
        command.most_seconds = kMostSeconds;
        command.lock = &lock_;
        log_ << "== " << converter_.kind->name << ' ' << utf8_of(source) << '\n';
        std::string last;
        const ChildEnd end = run_child(
            command,
            [&](const std::string& line) {
                log_ << line << '\n';
                last = line;
            },
            progress_);
        log_.flush();
        if (end.overdue) return said(source, "it was not done after five minutes");
        const std::optional<fs::path> picture = picture_in(scrap_.path);
        if (!end.well() || !picture)
            return said(source, last.empty() ? "it says nothing" : "it says: " + quote_word(last));
        fs::rename(*picture, target, failure);
        if (failure) throw_unwritable(target, failure);
        return "";
    }

    // The same file in another place, by a link or as a copy.
    void bring(const fs::path& source, const fs::path& target) {
        std::error_code failure;
        fs::remove(target, failure);
        fs::create_hard_link(source, target, failure);
        if (!failure) return;
        const fs::path part = scrap_.path / "copy";
        fs::copy_file(source, part, fs::copy_options::overwrite_existing, failure);
        if (!failure) fs::rename(part, target, failure);
        if (failure) throw_unwritable(target, failure);
    }

    void note(const std::string& line) { log_ << "-- " << line << '\n'; }

  private:
    std::string said(const fs::path& source, const std::string& why) const {
        return "The photo '" + utf8_of(source.filename()) + "' could not be converted by " +
               converter_.kind->name + " and was left out (" + why + ").";
    }

    Converter converter_;
    ScrapFolder scrap_;
    std::ofstream log_;
    FolderLock& lock_;
    Progress* progress_;
};

// Which photo becomes which file: by the file's name.
std::map<std::string, PhotoFile> names_for(const PhotoFolder& photos) {
    std::map<std::string, PhotoFile> names;
    std::set<std::string> taken;  // on some disks a and A are one
    for (const PhotoFile& photo : photos.photos) {
        names[photo.name] = photo;
        taken.insert(lower_case(photo.name));
    }
    for (const PhotoFile& photo : photos.heics) {
        std::string name = stem_of(photo.name) + ".jpg";
        for (int i = 1; !taken.insert(lower_case(name)).second; i++)
            name = photo.name + (i > 1 ? "_" + std::to_string(i) : "") + ".jpg";
        names[name] = photo;
    }
    return names;
}

// What was made here of photos that are gone; nothing that somebody else put there.
void remove_gone(const fs::path& folder, const json& made, const json& now) {
    std::error_code failure;
    for (const auto& [name, ignored] : made.items())
        if (!now.contains(name) && !path_of(name).has_parent_path())
            fs::remove(folder / path_of(name), failure);
}

// Names that are no UTF-8 are possible on Linux.
std::string text_of(const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

ReadablePhotos readable_photos(const std::string& folder, const std::string& out, Progress* progress) {
    const PhotoFolder photos = list_all_photos(folder);
    ReadablePhotos result;
    result.folder = folder;
    if (photos.heics.empty()) return result;
    const size_t all = photos.photos.size() + photos.heics.size();
    if (all < kLeastPhotos) throw too_few_photos(all, folder);
    const std::optional<Converter> converter = find_converter();
    if (!converter) return result;
    const fs::path whole = path_of(claim_folder(out, photos.path)), made = whole / "photos";
    FolderLock lock(utf8_of(whole / "colmap" / "lock"));
    const fs::path mark = whole / "colmap" / "heic.json";
    std::error_code failure;
    if (fs::exists(made, failure) &&
        (!fs::exists(mark, failure) || fs::equivalent(made, path_of(photos.path), failure)))
        throw Error("'" + utf8_of(made) +
                    "' is there already, and was not made of HEIC photos here; it was left as it is. Name "
                    "another folder to write to.");
    RunStage stage(utf8_of(mark), kMethod);
    json done = json::parse(stage.note(), nullptr, false);
    if (!done.is_object()) done = json::object();
    stage.begin(text_of(done));
    make_folder(utf8_of(made));
    Conversion conversion(*converter, whole, lock, progress);

    json now = json::object();
    size_t at = 0, broken = 0;
    for (const auto& [name, photo] : names_for(photos)) {
        if (progress) {
            progress->check();
            progress->update(static_cast<double>(at) / static_cast<double>(all), kStage);
            progress->count(at++, all);
        }
        const fs::path source = path_of(photos.path) / path_of(photo.name), target = made / path_of(name);
        const json from = {utf8_of(source), photo.bytes, photo.written};
        const bool heic = is_heic_name(photo.name);
        const auto was = done.find(name);
        // A file of another size was changed, or not written to its end before the power went.
        const bool same = was != done.end() && was->is_array() && was->size() == 2 && (*was)[0] == from &&
                          fs::is_regular_file(target, failure) && (*was)[1] == fs::file_size(target, failure);
        if (!same && heic) {
            const std::string wrong = conversion.convert(source, target);
            if (!wrong.empty()) {
                conversion.note(wrong);
                if (broken++ < kMostNamed) result.warnings.push_back(wrong);
                continue;
            }
        } else if (!same) {
            conversion.bring(source, target);
        }
        result.converted += heic;
        now[name] = done[name] = {from, fs::file_size(target, failure)};
        if (!same && heic) stage.begin(text_of(done));
    }
    if (now.size() < kLeastPhotos)
        throw Error((result.converted == 0 ? "None of the "
                                           : "Only " + std::to_string(result.converted) + " of the ") +
                    std::to_string(photos.heics.size()) + " HEIC photos in '" + folder +
                    "' could be converted, and a tree needs " + std::to_string(kLeastPhotos) +
                    " photos or more. " + result.warnings[0]);
    if (broken > kMostNamed)
        result.warnings.push_back("So were " + std::to_string(broken - kMostNamed) +
                                  " more photos; photos.log names them.");
    result.warnings.insert(result.warnings.end(), photos.warnings.begin(), photos.warnings.end());
    remove_gone(made, done, now);
    stage.finish(text_of(now));
    result.folder = utf8_of(made);
    return result;
}

}  // namespace treerec

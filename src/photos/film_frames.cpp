#include "photos/film_frames.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/child_process.h"
#include "photos/choose_frames.h"
#include "photos/find_program.h"
#include "photos/folder_lock.h"
#include "photos/photo_folder.h"
#include "photos/photo_picture.h"
#include "photos/run_colmap.h"
#include "photos/run_stage.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMethod = "frames 2";  // another number where other frames come out
constexpr double kMostPerSecond = 10.0;      // frames that are looked at
constexpr double kLeastPerSecond = 2.0;
// Of a short film more of a second: what moves farther from one to the next is not found again, and there
// have to be some for each that is taken.
constexpr double kLeastLooked = 600.0;
constexpr double kShake = 0.5;          // seconds before and after: what comes back within is a shake
constexpr double kMostLooked = 1500.0;  // frames of a long film
constexpr int kLooked = 480;            // pixels of the longer side, for the sharpness
constexpr int kSmaller = 3;             // as many times smaller for the motion
constexpr double kLookEnd = 0.5;        // of the progress
constexpr double kMostSeconds = 3600.0;

const char* how_to_install() {
#ifdef _WIN32
    return "Install it with 'winget install ffmpeg', or unpack it into C:\\ffmpeg.";
#elif defined(__APPLE__)
    return "Install it with 'brew install ffmpeg'.";
#else
    return "Install it ('sudo apt install ffmpeg' on Debian and Ubuntu).";
#endif
}

std::string find_ffmpeg() {
    const std::string found =
        find_program("ffmpeg", "FFMPEG", {"C:\\ffmpeg\\bin", "C:\\ffmpeg", "C:\\Program Files\\ffmpeg\\bin"});
    if (!found.empty()) return found;
    throw Error(
        std::string("Taking photos out of a film needs the program ffmpeg, which is not on this machine. ") +
        how_to_install() + " Or take the photos out of it by another program.");
}

// "00:01:02.50" after `word` in seconds; negative without one.
double time_after(const std::string& line, const char* word) {
    const size_t at = line.find(word);
    int hours = 0, minutes = 0;
    double seconds = 0.0;
    if (at == std::string::npos || std::sscanf(line.c_str() + at + std::string_view(word).size(), "%d:%d:%lf",
                                               &hours, &minutes, &seconds) != 3)
        return -1.0;
    return 3600.0 * hours + 60.0 * minutes + seconds;
}

// The film's frames of a second, of ffmpeg's line about its pictures; infinite where that doesn't tell.
double rate_in(const std::string& line) {
    const size_t end = line.find(" fps,");
    if (end == std::string::npos) return INFINITY;
    const size_t before = line.rfind(' ', end - 1);
    double rate = 0.0;
    char next = 0;  // "1k fps" is told, too
    if (before == std::string::npos || std::sscanf(line.c_str() + before, "%lf%c", &rate, &next) != 2 ||
        next != ' ' || !(rate > 0.0))
        return INFINITY;
    return rate;
}

std::string number_text(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 4).ptr};
}

class Ffmpeg {
  public:
    Ffmpeg(std::string program, const std::string& film, const fs::path& log, FolderLock& lock,
           Progress* progress)
        : program_(std::move(program)),
          film_(film),
          log_(log, std::ios::binary | std::ios::app),
          lock_(lock),
          progress_(progress) {
        if (!log_) throw Error("'" + utf8_of(log) + "' cannot be written.");
    }

    struct About {
        double seconds = -1.0;  // negative where it isn't told
        double rate = INFINITY;
    };

    // How long the film is, and its frames of a second. Throws Error where it is none.
    About about() {
        About film;
        bool pictures = false;
        std::string last;
        // It asks for something to write, and ends.
        run({"-i", "file:" + film_}, [&](const std::string& line) {
            film.seconds = std::max(film.seconds, time_after(line, "Duration: "));
            // Covers of songs are pictures, too.
            if (!pictures && line.find("Video: ") != std::string::npos &&
                line.find("attached pic") == std::string::npos) {
                pictures = true;
                film.rate = rate_in(line);
            }
            if (line.find("At least one output file") == std::string::npos) last = line;
        });
        if (!pictures)
            throw Error("'" + film_ + "' is no film that ffmpeg can read (it says: " + quote_word(last) +
                        ").");
        return film;
    }

    // Passes all frames through `filters` into `to`. Throws Error.
    void write(const std::string& filters, const std::vector<std::string>& to, double seconds, double begin,
               double end) {
        std::vector<std::string> words = {"-y", "-i", "file:" + film_, "-map", "0:V:0", "-vf", filters};
        words.insert(words.end(), to.begin(), to.end());
        std::string last;
        const ChildEnd done = run(words, [&](const std::string& line) {
            last = line;
            const double at = time_after(line, "time=");
            if (progress_ && at > 0.0 && seconds > 0.0)
                progress_->update(begin + (end - begin) * std::min(at / seconds, 1.0), "Film");
        });
        if (done.overdue)
            throw Error("ffmpeg was not done with '" + film_ +
                        "' after an hour and was ended; cut the film down to one walk around the tree.");
        if (!done.well())
            throw Error("ffmpeg could not take pictures out of '" + film_ +
                        "' (it says: " + quote_word(last) + ").");
    }

  private:
    ChildEnd run(const std::vector<std::string>& words,
                 const std::function<void(const std::string&)>& on_line) {
        ChildCommand command;
        command.program = program_;
        command.arguments = {"-hide_banner", "-nostdin"};
        command.arguments.insert(command.arguments.end(), words.begin(), words.end());
        command.most_seconds = kMostSeconds;
        command.lock = &lock_;
        log_ << "== ffmpeg";
        for (const std::string& word : words)
            log_ << ' ' << word;
        log_ << '\n';
        const ChildEnd end = run_child(
            command,
            [&](const std::string& line) {
                log_ << line << '\n';
                on_line(line);
            },
            progress_);
        log_.flush();
        return end;
    }

    std::string program_;
    std::string film_;
    std::ofstream log_;
    FolderLock& lock_;
    Progress* progress_;
};

// The pictures of a file of PGM after PGM, grey and of 8 bits, as ffmpeg writes them. One that is cut off is
// left out.
std::vector<std::string_view> cut_pictures(std::string_view bytes, int& width, int& height) {
    std::vector<std::string_view> pictures;
    width = height = 0;
    while (bytes.starts_with("P5\n")) {
        int w = 0, h = 0, most = 0, head = 0;
        const std::string begin(bytes.substr(0, 64));
        if (std::sscanf(begin.c_str(), "P5\n%d %d\n%d%n", &w, &h, &most, &head) != 3 || most != 255) break;
        if (w < 1 || h < 1 || w > kLooked || h > kLooked || (width > 0 && (w != width || h != height))) break;
        width = w;
        height = h;
        const size_t size = static_cast<size_t>(w) * static_cast<size_t>(h),
                     start = static_cast<size_t>(head) + 1;
        if (bytes.size() < start + size) break;
        pictures.push_back(bytes.substr(start, size));
        bytes.remove_prefix(start + size);
    }
    return pictures;
}

std::vector<FrameLook> look_at(const std::string& path, Progress* progress) {
    const FileBytes file = read_file(path);
    int width = 0, height = 0;
    const std::vector<std::string_view> pictures = cut_pictures(file.view(), width, height);
    const auto picture_of = [&](size_t i) {
        Image picture(width, height, 1);
        std::copy(pictures[i].begin(), pictures[i].end(), picture.pixels.begin());
        return picture;
    };
    std::vector<FrameLook> looks(pictures.size());
    parallel_for(pictures.size(), 16, [&](size_t first, size_t last) {
        if (progress) progress->check();
        Image before;
        if (first > 0 && first < last) before = reduced(picture_of(first - 1), kSmaller);
        for (size_t i = first; i < last; i++) {
            const Image picture = picture_of(i);
            Image small = reduced(picture, kSmaller);
            looks[i].sharpness = sharpness_of(picture);
            if (i > 0) looks[i].moved = motion_between(before, small);
            before = std::move(small);
        }
    });
    return looks;
}

// "(eq(n,3)+eq(n,17))": in halves, since ffmpeg adds up no more than a hundred in a row.
std::string sum_of(std::span<const size_t> chosen) {
    if (chosen.size() == 1) return "eq(n," + std::to_string(chosen[0]) + ")";
    const size_t half = chosen.size() / 2;
    return "(" + sum_of(chosen.first(half)) + "+" + sum_of(chosen.subspan(half)) + ")";
}

// Of one frame or more.
std::string selection_of(const std::vector<size_t>& chosen) {
    return "select='" + sum_of(chosen) + "'";
}

// Goes when its work is done or given up.
struct Scrap {
    fs::path path;
    ~Scrap() {
        std::error_code failure;
        fs::remove(path, failure);
    }
};

size_t photos_in(const fs::path& folder) {
    size_t count = 0;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
        count += extension_of(utf8_of(at->path().filename())) == "jpg";
    return count;
}

std::string basis_of(const fs::path& film) {
    std::error_code failure;
    return std::string(kMethod) + " " + utf8_of(film) + " " + std::to_string(fs::file_size(film, failure)) +
           " " + std::to_string(fs::last_write_time(film, failure).time_since_epoch().count());
}

// "frame_00012.033s.jpg": where in the film it is, and in the walk's order by name.
std::string name_at(double seconds) {
    const long long thousandths = std::llround(1000.0 * seconds);
    char text[64];
    std::snprintf(text, sizeof text, "frame_%05lld.%03llds.jpg", thousandths / 1000, thousandths % 1000);
    return text;
}

// Names what ffmpeg has numbered by the times of the `chosen`.
void name_by_times(const fs::path& folder, const std::vector<size_t>& chosen, double rate) {
    for (size_t k = 0; k < chosen.size(); k++) {
        const fs::path numbered = folder / (std::to_string(k + 1) + ".jpg");
        const fs::path named = folder / name_at(static_cast<double>(chosen[k]) / rate);
        std::error_code failure;
        if (!fs::exists(numbered, failure)) continue;
        fs::rename(numbered, named, failure);
        if (failure)
            throw Error("The photo '" + utf8_of(named) + "' cannot be written: " + failure.message() + ".");
    }
}

// Where the pattern of names begins a number, a folder's own % has to be doubled.
std::string pattern_in(const fs::path& folder) {
    std::string pattern;
    for (const char c : utf8_of(folder))
        pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern + "/%d.jpg";
}

}  // namespace

std::optional<std::string> film_of(const std::string& input) {
    std::error_code failure;
    const fs::path place = path_of(input);
    if (fs::is_regular_file(place, failure)) {
        if (is_photo_name(input) || is_heic_name(input))
            throw Error("'" + input + "' is a single photo; name the folder that it is in.");
        return input;
    }
    if (!fs::is_directory(place, failure)) return {};
    std::vector<std::string> films;
    size_t photos = 0;
    for (fs::directory_iterator at(place, failure), end; !failure && at != end; at.increment(failure)) {
        const std::string name = utf8_of(at->path().filename());
        if (name.starts_with(".")) continue;
        photos += is_photo_name(name) || is_heic_name(name);
        if (is_film_name(name)) films.push_back(utf8_of(at->path()));
    }
    if (films.empty() || photos >= kLeastPhotos) return {};
    if (films.size() > 1)
        throw Error("There are " + std::to_string(films.size()) + " films in '" + input +
                    "' and too few photos; name the one to take: one walk around the tree.");
    return films[0];
}

FilmPhotos photos_of_film(const std::string& film, const std::string& out, Progress* progress) {
    if (progress) progress->update(0.0, "Film");
    std::error_code failure;
    const fs::path source = fs::absolute(path_of(film), failure).lexically_normal();
    if (failure || !fs::is_regular_file(source, failure)) throw Error("There is no film '" + film + "'.");
    const fs::path whole = path_of(claim_folder(out, utf8_of(source.parent_path() / ".")));
    FolderLock lock(utf8_of(whole / "colmap" / "lock"));
    FilmPhotos result;
    const fs::path photos = whole / "frames", part = whole / "colmap" / "frames.part";
    result.folder = utf8_of(photos);
    const fs::path mark = whole / "colmap" / "film.json";
    if (fs::exists(photos, failure) && !fs::exists(mark, failure))
        throw Error("'" + utf8_of(photos) +
                    "' is there already, and was not made of a film here; it was left as it is. Name another "
                    "folder to write to.");
    RunStage stage(utf8_of(mark), basis_of(source));
    result.photos = photos_in(photos);
    if (stage.done() && result.photos > 0) {
        size_t made = 0;
        // What was taken out of the folder since is made again.
        if (std::sscanf(stage.note().c_str(), "%zu frames of %lf s", &made, &result.seconds) == 2 &&
            made == result.photos)
            return result;
    }

    Ffmpeg ffmpeg(find_ffmpeg(), utf8_of(source), whole / "photos.log", lock, progress);
    stage.begin();
    const Ffmpeg::About about = ffmpeg.about();
    result.seconds = about.seconds;
    double rate = kLeastPerSecond;
    if (about.seconds > 0.0) {
        rate = std::clamp(kMostLooked / about.seconds, kLeastPerSecond, kMostPerSecond);
        rate = std::min(std::max(rate, kLeastLooked / about.seconds), std::max(about.rate, kLeastPerSecond));
    }
    // What is shown at a time is what began then or before.
    const std::string frames = "fps=" + number_text(rate) + ":round=up", side = std::to_string(kLooked);
    const Scrap scrap{whole / "colmap" / "film.pgm"};
    const std::string looked = utf8_of(scrap.path);
    ffmpeg.write(frames + ",scale=" + side + ":" + side + ":force_original_aspect_ratio=decrease,format=gray",
                 {"-f", "image2pipe", "-c:v", "pgm", "file:" + looked}, result.seconds, 0.0, kLookEnd);
    const std::vector<FrameLook> looks = look_at(looked, progress);
    FrameChoice choice;
    choice.smoothed = static_cast<size_t>(std::max(std::lround(kShake * rate), 1L));
    const std::vector<size_t> chosen = choose_frames(looks, choice);
    if (chosen.empty())
        throw Error(
            "The film '" + film +
            "' shows no walk around a tree: too little moves in it. Walk all the way around, and film a "
            "minute or so.");
    fs::remove_all(part, failure);
    make_folder(utf8_of(part));
    // Frames that follow each other in time: ffmpeg would fill the gaps otherwise.
    ffmpeg.write(frames + "," + selection_of(chosen) + ",setpts=N/FRAME_RATE/TB",
                 {"-f", "image2", "-c:v", "mjpeg", "-q:v", "2", pattern_in(part)}, result.seconds, kLookEnd,
                 1.0);
    name_by_times(part, chosen, rate);
    result.photos = photos_in(part);
    if (result.photos == 0)
        throw Error("ffmpeg took no pictures out of '" + film + "'; photos.log has what it says.");
    fs::remove_all(photos, failure);
    fs::rename(part, photos, failure);
    if (failure)
        throw Error("The folder '" + utf8_of(photos) + "' cannot be written: " + failure.message() + ".");
    stage.finish(std::to_string(result.photos) + " frames of " + number_text(result.seconds) + " s");
    return result;
}

}  // namespace treerec

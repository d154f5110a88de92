#include "photos/photo_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/jpeg_segments.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPhotos[] = {"jpg", "jpeg", "png", "tif", "tiff", "bmp"};
constexpr std::string_view kApples[] = {"heic", "heif", "avif"};
constexpr std::string_view kFilms[] = {"mp4", "mov", "m4v", "avi", "mkv", "webm"};

#ifdef _WIN32
constexpr const char* kInstall = "install ImageMagick 7 with 'winget install ImageMagick.ImageMagick'";
#elif defined(__APPLE__)
constexpr const char* kInstall = "install libheif with 'brew install libheif'";
#else
constexpr const char* kInstall =
    "install libheif's ('sudo apt install libheif-examples' on Debian and Ubuntu)";
#endif

template <size_t kCount>
bool is_one_of(const std::string& ending, const std::string_view (&endings)[kCount]) {
    return std::find(std::begin(endings), std::end(endings), ending) != std::end(endings);
}

int big_endian(const unsigned char* bytes, int count) {
    int value = 0;
    for (int i = 0; i < count; i++)
        value = value << 8 | bytes[i];
    return value;
}

// Width and height as a JPEG's frame header says; 0 where there is none.
std::pair<int, int> jpeg_size(std::ifstream& in) {
    std::pair<int, int> found{0, 0};
    in.seekg(0);
    each_jpeg_segment(in, [&](int marker, size_t) {
        // A frame header: all of this row but tables of Huffman codes, an extension, and arithmetic ones.
        if (marker < 0xC0 || marker > 0xCF || marker == 0xC4 || marker == 0xC8 || marker == 0xCC) return true;
        unsigned char head[5];
        if (in.read(reinterpret_cast<char*>(head), 5))
            found = {big_endian(head + 3, 2), big_endian(head + 1, 2)};
        return false;
    });
    return found;
}

// What COLMAP's list of pictures, a text of lines, can't hold.
bool fits_a_line(const std::string& name) {
    return name.find_first_of("\r\n") == std::string::npos && name.front() != ' ' && name.front() != '\t';
}

std::string how_to_convert(size_t apples, const std::string& folder) {
    return std::to_string(apples) + (apples == 1 ? " picture in '" : " pictures in '") + folder + "' " +
           (apples == 1 ? "is" : "are") +
           " HEIC, as phones save them, which COLMAP does not read. They are converted to JPEG where one of "
           "the programs heif-dec, heif-convert, sips (a part of macOS) or magick is there: " +
           kInstall + ". Or set the camera to 'most compatible'.";
}

}  // namespace

bool is_photo_name(const std::string& name) {
    return is_one_of(extension_of(name), kPhotos);
}

bool is_heic_name(const std::string& name) {
    return is_one_of(extension_of(name), kApples);
}

bool is_film_name(const std::string& name) {
    return is_one_of(extension_of(name), kFilms);
}

bool PhotoFolder::one_size() const {
    return !photos.empty() && std::all_of(photos.begin(), photos.end(), [&](const PhotoFile& photo) {
        return photo.width > 0 && photo.width == photos[0].width && photo.height == photos[0].height;
    });
}

std::pair<int, int> size_of_picture(const std::string& path) {
    std::ifstream in(path_of(path), std::ios::binary);
    std::array<unsigned char, 24> head{};
    if (!in.read(reinterpret_cast<char*>(head.data()), head.size())) return {0, 0};
    if (head[0] == 0xFF && head[1] == 0xD8) return jpeg_size(in);
    if (std::string_view(reinterpret_cast<const char*>(head.data()), 8) == "\x89PNG\r\n\x1a\n")
        return {big_endian(&head[16], 4), big_endian(&head[20], 4)};
    return {0, 0};
}

PhotoFolder list_all_photos(const std::string& folder) {
    std::error_code failure;
    if (!fs::is_directory(path_of(folder), failure))
        throw Error("'" + folder + "' is no folder; name the one with the photos in it.");
    PhotoFolder found;
    found.path = utf8_of(fs::canonical(path_of(folder), failure));
    if (failure) throw Error("The folder '" + folder + "' cannot be reached.");
    std::vector<std::string> films;
    std::set<std::string> stems, jpegs;
    fs::directory_iterator at(path_of(found.path), failure);
    for (const fs::directory_iterator end; !failure && at != end; at.increment(failure)) {
        std::error_code ignored;
        const std::string name = utf8_of(at->path().filename());
        // macOS's notes beside each file on foreign disks are called "._IMG_1.jpg".
        if (name.starts_with(".") || !at->is_regular_file(ignored)) continue;
        if (is_film_name(name)) films.push_back(name);
        const bool heic = is_heic_name(name);
        if (!heic && !is_photo_name(name)) continue;
        if (!fits_a_line(name))
            throw Error(
                "The photo " + quote_word(name) +
                " has a name that COLMAP can't be told: rename it so that it begins with no blank and "
                "has no line break in it.");
        PhotoFile photo;
        photo.name = name;
        photo.bytes = at->file_size(ignored);
        photo.written = at->last_write_time(ignored).time_since_epoch().count();
        if (!heic) std::tie(photo.width, photo.height) = size_of_picture(utf8_of(at->path()));
        stems.insert(stem_of(name));
        if (extension_of(name).starts_with("jp")) jpegs.insert(stem_of(name));
        (heic ? found.heics : found.photos).push_back(std::move(photo));
    }
    if (failure) throw Error("The folder '" + folder + "' cannot be read.");
    // Phones export both.
    std::erase_if(found.heics, [&](const PhotoFile& photo) { return jpegs.count(stem_of(photo.name)) > 0; });
    for (std::vector<PhotoFile>* list : {&found.photos, &found.heics})
        std::sort(list->begin(), list->end(),
                  [](const PhotoFile& a, const PhotoFile& b) { return a.name < b.name; });
    if (found.photos.empty() && found.heics.empty())
        throw Error("There are no photos in '" + folder + "' (.jpg .png .tif .bmp .heic).");
    // The moment around a photo that phones save as a film of the same name is not meant.
    std::erase_if(films, [&](const std::string& film) { return stems.count(stem_of(film)) > 0; });
    if (!films.empty())
        found.warnings.push_back(
            "The film " + quote_word(*std::min_element(films.begin(), films.end())) +
            " was left out, since there are photos beside it; name the film to take it.");
    return found;
}

PhotoFolder list_photos(const std::string& folder) {
    PhotoFolder found = list_all_photos(folder);
    if (found.heics.empty()) return found;
    if (found.photos.empty()) throw Error(how_to_convert(found.heics.size(), folder));
    found.warnings.insert(found.warnings.begin(), how_to_convert(found.heics.size(), folder));
    return found;
}

}  // namespace treerec

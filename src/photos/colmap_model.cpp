#include "photos/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>

#include "error.h"
#include "file_bytes.h"
#include "geometry/portable_math.h"
#include "photos/binary_reader.h"

namespace treerec {

namespace {

struct Lens {
    LensModel model;
    const char* name;
    int parameters;
};
constexpr Lens kLenses[] = {
    {LensModel::kSimplePinhole, "SIMPLE_PINHOLE", 3},
    {LensModel::kPinhole, "PINHOLE", 4},
    {LensModel::kSimpleRadial, "SIMPLE_RADIAL", 4},
    {LensModel::kRadial, "RADIAL", 5},
    {LensModel::kOpenCv, "OPENCV", 8},
    {LensModel::kOpenCvFisheye, "OPENCV_FISHEYE", 8},
    {LensModel::kFullOpenCv, "FULL_OPENCV", 12},
    {LensModel::kSimpleRadialFisheye, "SIMPLE_RADIAL_FISHEYE", 4},
    {LensModel::kRadialFisheye, "RADIAL_FISHEYE", 5},
};

constexpr int64_t kLargestPicture = 1 << 16;  // pixels of a side

[[noreturn]] void fail(const std::string& path, const std::string& what) {
    throw Error("The COLMAP model '" + path + "' " + what);
}

const Lens& lens_of(const std::string& path, const std::string& name, int64_t number) {
    for (const Lens& lens : kLenses)
        if (name.empty() ? static_cast<int64_t>(lens.model) == number : name == lens.name) return lens;
    const std::string what = name.empty() ? "number " + std::to_string(number) : quote_word(name);
    fail(path, "has a camera of a model that is not known here (" + what +
                   "); undistort the pictures with COLMAP first.");
}

void check_camera(const std::string& path, const Camera& camera, int64_t width, int64_t height) {
    bool sound = width > 0 && height > 0 && width <= kLargestPicture && height <= kLargestPicture &&
                 camera.parameters[0] > 0.0;
    for (double parameter : camera.parameters)
        sound = sound && std::isfinite(parameter);
    if (!sound) fail(path, "is damaged: it has a camera without a size or a focal length.");
}

void check_photo(const std::string& path, Photo& photo) {
    double square = 0.0;
    for (double q : photo.rotation)
        square += q * q;
    if (!(square > 1e-12 && square < 1e12) || !std::isfinite(photo.translation.x) ||
        !std::isfinite(photo.translation.y) || !std::isfinite(photo.translation.z))
        fail(path, "is damaged: the place of " + quote_word(photo.name) + " is no place.");
    for (double& q : photo.rotation)
        q /= std::sqrt(square);
}

struct Cameras {
    PhotoModel model;
    std::map<uint32_t, int> index;  // by COLMAP's id

    void add(const std::string& path, uint32_t id, const Camera& camera) {
        if (!index.emplace(id, static_cast<int>(model.cameras.size())).second)
            fail(path, "is damaged: it has camera " + std::to_string(id) + " twice.");
        model.cameras.push_back(camera);
    }
    void add(const std::string& path, Photo photo, uint32_t camera) {
        check_photo(path, photo);
        const auto found = index.find(camera);
        if (found == index.end())
            fail(path, "is damaged: " + quote_word(photo.name) + " has a camera that is not there.");
        photo.camera = found->second;
        model.photos.push_back(std::move(photo));
    }
};

// What a file holds, and what it is called.
struct Source {
    const std::string& path;
    std::string_view bytes;
};

void read_binary(const Source& camera_source, const Source& image_source, Cameras& into) {
    const std::string &cameras = camera_source.path, &images = image_source.path;
    BinaryReader in(cameras, camera_source.bytes);
    const auto count = in.value<uint64_t>();
    for (uint64_t i = 0; i < count; i++) {
        const auto id = in.value<uint32_t>();
        const Lens& lens = lens_of(cameras, "", in.value<int32_t>());
        const auto width = static_cast<int64_t>(in.value<uint64_t>());
        const auto height = static_cast<int64_t>(in.value<uint64_t>());
        std::array<double, 12> parameters{};
        for (int k = 0; k < lens.parameters; k++)
            parameters[static_cast<size_t>(k)] = in.value<double>();
        into.add(cameras, id,
                 checked_camera(static_cast<int64_t>(lens.model), width, height, parameters, cameras));
    }
    BinaryReader image_in(images, image_source.bytes);
    const auto photos = image_in.value<uint64_t>();
    for (uint64_t i = 0; i < photos; i++) {
        Photo photo;
        photo.number = image_in.value<uint32_t>();
        for (double& q : photo.rotation)
            q = image_in.value<double>();
        for (int k = 0; k < 3; k++)
            photo.translation[k] = image_in.value<double>();
        const auto camera = image_in.value<uint32_t>();
        photo.name = image_in.text();
        image_in.skip(image_in.value<uint64_t>(), 8 + 8 + 8);
        into.add(images, std::move(photo), camera);
    }
}

// Lines that are no comments.
std::vector<std::string> lines_of(std::string_view bytes) {
    std::istringstream in{std::string(bytes)};
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty() || line[0] != '#') lines.push_back(line);
    }
    while (!lines.empty() && lines.back().empty())
        lines.pop_back();
    return lines;
}

void read_text(const Source& camera_source, const Source& image_source, Cameras& into) {
    const std::string &cameras = camera_source.path, &images = image_source.path;
    for (const std::string& line : lines_of(camera_source.bytes)) {
        if (line.empty()) continue;
        std::istringstream in(line);
        in.imbue(std::locale::classic());
        uint32_t id = 0;
        std::string name;
        int64_t width = 0, height = 0;
        in >> id >> name >> width >> height;
        if (!in) fail(cameras, "has a line that is no camera: " + quote_word(line) + ".");
        const Lens& lens = lens_of(cameras, name, -1);
        Camera camera;
        camera.model = lens.model;
        for (int k = 0; k < lens.parameters; k++)
            in >> camera.parameters[static_cast<size_t>(k)];
        if (!in) fail(cameras, "has a line that is no camera: " + quote_word(line) + ".");
        check_camera(cameras, camera, width, height);
        camera.width = static_cast<int>(width);
        camera.height = static_cast<int>(height);
        into.add(cameras, id, camera);
    }
    // Two lines each; the second holds the points that the photo saw, and may be empty.
    const std::vector<std::string> lines = lines_of(image_source.bytes);
    for (size_t i = 0; i < lines.size(); i += 2) {
        std::istringstream in(lines[i]);
        in.imbue(std::locale::classic());
        uint32_t camera = 0;
        Photo photo;
        in >> photo.number;
        for (double& q : photo.rotation)
            in >> q;
        in >> photo.translation.x >> photo.translation.y >> photo.translation.z >> camera >> std::ws;
        std::getline(in, photo.name);
        if (photo.name.empty()) fail(images, "has a line that is no photo: " + quote_word(lines[i]) + ".");
        into.add(images, std::move(photo), camera);
    }
}

// Distorts (x, y) by radial coefficients k of r^2, r^4, ..; nothing where the radius no longer grows.
std::optional<double> radial(double r2, std::initializer_list<double> k) {
    double factor = 1.0, slope = 1.0, power = 1.0;
    int order = 1;
    for (double coefficient : k) {
        power *= r2;
        factor += coefficient * power;
        slope += (2 * order + 1) * coefficient * power;
        order++;
    }
    return slope > 0.0 ? std::optional(factor) : std::nullopt;
}

}  // namespace

std::optional<DVec2> Camera::project(const DVec3& p) const {
    if (!(p.z > 0.0)) return std::nullopt;
    const auto& v = parameters;
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
    const bool two = model == LensModel::kPinhole || model == LensModel::kOpenCv ||
                     model == LensModel::kOpenCvFisheye || model == LensModel::kFullOpenCv;
    const double fx = v[0], fy = two ? v[1] : v[0], cx = two ? v[2] : v[1], cy = two ? v[3] : v[2];
    DVec2 out(x, y);
    std::optional<double> factor = 1.0;
    const auto fisheye = [&](std::initializer_list<double> k) -> std::optional<double> {
        const double r = std::sqrt(r2);
        if (r < 1e-12) return 1.0;
        const double angle = portable::atan(r);
        const std::optional<double> bent = radial(angle * angle, k);
        return bent ? std::optional(*bent * angle / r) : std::nullopt;
    };
    switch (model) {
        case LensModel::kSimplePinhole:
        case LensModel::kPinhole:
            break;
        case LensModel::kSimpleRadial:
            factor = radial(r2, {v[3]});
            break;
        case LensModel::kRadial:
            factor = radial(r2, {v[3], v[4]});
            break;
        case LensModel::kOpenCv:
            factor = radial(r2, {v[4], v[5]});
            break;
        case LensModel::kOpenCvFisheye:
            factor = fisheye({v[4], v[5], v[6], v[7]});
            break;
        case LensModel::kFullOpenCv: {
            factor = radial(r2, {v[4], v[5], v[8]});
            const double below = 1.0 + r2 * (v[9] + r2 * (v[10] + r2 * v[11]));
            if (!(below > 0.0)) return std::nullopt;
            if (factor) *factor /= below;
            break;
        }
        case LensModel::kSimpleRadialFisheye:
            factor = fisheye({v[3]});
            break;
        case LensModel::kRadialFisheye:
            factor = fisheye({v[3], v[4]});
            break;
    }
    if (!factor) return std::nullopt;
    out *= *factor;
    if (model == LensModel::kOpenCv || model == LensModel::kFullOpenCv) {
        out.x += 2.0 * v[6] * x * y + v[7] * (r2 + 2.0 * x * x);
        out.y += 2.0 * v[7] * x * y + v[6] * (r2 + 2.0 * y * y);
    }
    return DVec2(fx * out.x + cx, fy * out.y + cy);
}

DVec3 Photo::to_camera(const DVec3& world) const {
    const DVec3 u(rotation[1], rotation[2], rotation[3]);
    const DVec3 t = 2.0 * glm::cross(u, world);
    return world + rotation[0] * t + glm::cross(u, t) + translation;
}

DMat3 Photo::turn() const {
    const auto seen = [&](const DVec3& direction) { return to_camera(direction) - translation; };
    return DMat3(seen({1, 0, 0}), seen({0, 1, 0}), seen({0, 0, 1}));
}

DVec3 Photo::centre() const {
    return -(glm::transpose(turn()) * translation);
}

DVec3 Photo::ahead() const {
    return glm::transpose(turn()) * DVec3(0, 0, 1);
}

std::optional<DVec3> Camera::ray(const DVec2& pixel) const {
    constexpr double kStep = 1e-4;
    constexpr int kRounds = 20;
    const auto middle = project({0.0, 0.0, 1.0});
    const double focal = focal_length();
    if (!middle || !(focal > 0.0)) return {};
    // Newton's method: a lens bends little.
    DVec2 found = (pixel - *middle) / focal;
    for (int round = 0; round < kRounds; round++) {
        const auto here = project({found.x, found.y, 1.0}), right = project({found.x + kStep, found.y, 1.0}),
                   below = project({found.x, found.y + kStep, 1.0});
        if (!here || !right || !below) return {};
        const glm::dmat2 slope((*right - *here) / kStep, (*below - *here) / kStep);
        if (!(std::abs(glm::determinant(slope)) > 1e-6 * focal * focal)) return {};
        const DVec2 miss = pixel - *here;
        found += glm::inverse(slope) * miss;
        if (glm::dot(miss, miss) < 1e-6) return DVec3(found, 1.0);
    }
    return {};
}

double Camera::focal_length() const {
    constexpr double kStep = 1e-4;
    const auto middle = project({0.0, 0.0, 1.0}), beside = project({kStep, 0.0, 1.0});
    return middle && beside ? std::abs(beside->x - middle->x) / kStep : 0.0;
}

PhotoModel parse_photo_model(std::string_view cameras, std::string_view images, bool text,
                             const std::string& folder) {
    Cameras into;
    const std::string ending = text ? ".txt" : ".bin";
    const std::string camera_path = utf8_of(path_of(folder) / ("cameras" + ending));
    const std::string image_path = utf8_of(path_of(folder) / ("images" + ending));
    (text ? read_text : read_binary)({camera_path, cameras}, {image_path, images}, into);
    PhotoModel& model = into.model;
    if (model.photos.empty()) throw Error("The COLMAP model in '" + folder + "' has no photos.");
    std::sort(model.photos.begin(), model.photos.end(),
              [](const Photo& a, const Photo& b) { return a.name < b.name; });
    for (size_t i = 1; i < model.photos.size(); i++)
        if (model.photos[i].name == model.photos[i - 1].name)
            throw Error("The COLMAP model in '" + folder + "' has the photo " +
                        quote_word(model.photos[i].name) + " twice.");
    return model;
}

PhotoModel held_out(const PhotoModel& model, size_t every) {
    PhotoModel held{model.cameras, {}};
    for (size_t i = 0; i < model.photos.size(); i++)
        if (every > 0 && (i + 1) % every == 0) held.photos.push_back(model.photos[i]);
    return held;
}

PhotoModel without_held_out(const PhotoModel& model, size_t every) {
    PhotoModel left{model.cameras, {}};
    for (size_t i = 0; i < model.photos.size(); i++)
        if (every == 0 || (i + 1) % every != 0) left.photos.push_back(model.photos[i]);
    return left;
}

Camera checked_camera(int64_t model, int64_t width, int64_t height, std::span<const double> parameters,
                      const std::string& source) {
    const Lens& lens = lens_of(source, "", model);
    Camera camera;
    camera.model = lens.model;
    const size_t count = static_cast<size_t>(lens.parameters);
    // Without them there is no focal length, which the check says.
    if (parameters.size() >= count)
        std::copy(parameters.begin(), parameters.begin() + lens.parameters, camera.parameters.begin());
    check_camera(source, camera, width, height);
    camera.width = static_cast<int>(width);
    camera.height = static_cast<int>(height);
    return camera;
}

PhotoModel read_photo_model(const std::string& folder, Progress* progress) {
    for (const bool text : {false, true}) {
        const std::string ending = text ? ".txt" : ".bin";
        const std::filesystem::path cameras = path_of(folder) / ("cameras" + ending);
        const std::filesystem::path images = path_of(folder) / ("images" + ending);
        std::error_code failure;
        if (!std::filesystem::is_regular_file(cameras, failure) ||
            !std::filesystem::is_regular_file(images, failure))
            continue;
        SubProgress reading(progress, 0.0, 0.0);
        const FileBytes camera_bytes = read_file(utf8_of(cameras), &reading),
                        image_bytes = read_file(utf8_of(images), &reading);
        reading.check();
        return parse_photo_model(camera_bytes.view(), image_bytes.view(), text, folder);
    }
    throw Error("There is no COLMAP model with cameras in '" + folder +
                "': it needs cameras.bin and images.bin, or both as .txt.");
}

}  // namespace treerec

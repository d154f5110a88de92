#include "python_cloud.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>

#include "arrays.h"
#include "file_bytes.h"
#include "python_progress.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace treerec {

namespace {

static_assert(sizeof(DVec3) == 3 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(float));

ScannedCloud read_file_cloud(const std::filesystem::path& path, const std::string& columns,
                             const std::string& classes, nb::object callback) {
    ScannedCloud scanned;
    const ReadCloudOptions options{parse_columns(columns), parse_classes(classes)};
    PythonProgress progress(std::move(callback));
    scanned.path = cloud_file_of(utf8_of(path));
    scanned.cloud =
        without_lock(progress, [&] { return read_cloud(scanned.path, options, &scanned.read, &progress); });
    return scanned;
}

template <typename T, typename Value>
std::vector<T> triples_of(const InArray<Value>& array) {
    std::vector<T> values(array.shape(0));
    if (!values.empty()) std::memcpy(values.data(), array.data(), values.size() * sizeof(T));
    return values;
}

ScannedCloud cloud_from_arrays(const InArray<double>& points, const InArray<float>& colors, float white,
                               nb::object callback) {
    ScannedCloud scanned;
    PythonProgress progress(std::move(callback));
    try {
        std::vector<DVec3> places = triples_of<DVec3>(points);
        std::vector<Vec3> shades = triples_of<Vec3>(colors);
        scanned.cloud = without_lock(progress, [&] {
            return cloud_of_places("points", std::move(places), std::move(shades), white, &scanned.read,
                                   &progress);
        });
    } catch (const std::bad_alloc&) {
        raise_no_memory();
    }
    return scanned;
}

nb::object points_of(const ScannedCloud& scanned) {
    const PointCloud& cloud = scanned.cloud;
    std::vector<DVec3> places(cloud.size());
    for (size_t i = 0; i < places.size(); i++)
        places[i] = cloud.frame.to_scan(DVec3(cloud.positions[i]));
    return nb::cast(array_of<double>(std::move(places), {cloud.size(), 3}));
}

}  // namespace

void bind_cloud(nb::module_& module) {
    nb::class_<ScannedCloud>(module, "Cloud")
        .def("__len__", [](const ScannedCloud& self) { return self.cloud.size(); })
        .def_prop_ro("points", points_of)
        .def_prop_ro(
            "colors",
            [](nb::handle_t<ScannedCloud> self) -> nb::object {
                const PointCloud& cloud = nb::cast<const ScannedCloud&>(self).cloud;
                if (!cloud.has_colors()) return nb::none();
                return nb::cast(view_of(cloud.colors[0].data(), std::array{cloud.size(), size_t{3}}, self));
            })
        .def_prop_ro(
            "normals",
            [](nb::handle_t<ScannedCloud> self) -> nb::object {
                const PointCloud& cloud = nb::cast<const ScannedCloud&>(self).cloud;
                if (!cloud.has_normals()) return nb::none();
                return nb::cast(view_of(&cloud.normals[0].x, std::array{cloud.size(), size_t{3}}, self));
            })
        .def_prop_ro("labels",
                     [](nb::handle_t<ScannedCloud> self) -> nb::object {
                         const PointCloud& cloud = nb::cast<const ScannedCloud&>(self).cloud;
                         if (cloud.labels.empty()) return nb::none();
                         return nb::cast(view_of(cloud.labels.values.data(), std::array{cloud.size()}, self));
                     })
        .def_prop_ro("label_column", [](const ScannedCloud& self) { return self.cloud.labels.column; })
        .def_prop_ro("metres_per_unit", [](const ScannedCloud& self) { return self.cloud.unit.metres; })
        .def_prop_ro("path", [](const ScannedCloud& self) { return self.path; })
        .def_prop_ro("format", [](const ScannedCloud& self) { return self.read.format; })
        .def_prop_ro("warnings", [](const ScannedCloud& self) { return self.read.warnings; })
        .def(
            "write",
            [](const ScannedCloud& self, const std::filesystem::path& path) {
                write_cloud(utf8_of(path), self.cloud);
            },
            "path"_a, nb::call_guard<nb::gil_scoped_release>());
    module.def("read_cloud", read_file_cloud, "path"_a, "columns"_a, "classes"_a, "progress"_a.none());
    module.def("cloud_from_arrays", cloud_from_arrays, "points"_a, "colors"_a, "white"_a,
               "progress"_a.none());
}

}  // namespace treerec

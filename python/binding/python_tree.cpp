#include "python_tree.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <utility>

#include "arrays.h"
#include "exchange/lstring_file.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "pipeline/export.h"
#include "pipeline/report.h"
#include "pipeline/scan_report.h"
#include "python_cloud.h"
#include "python_progress.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace treerec {

PythonTree::PythonTree(std::shared_ptr<const Reconstruction> made, std::string leaves, uint64_t seed,
                       std::string report)
    : made_(std::move(made)), leaves_(std::move(leaves)), seed_(seed), report_(std::move(report)) {
    std::vector<int32_t> place(static_cast<size_t>(tree().id_end()), -1);
    for (const NodeId id : tree().depth_first()) {
        const Node& node = tree().node(id);
        place[static_cast<size_t>(id)] = static_cast<int32_t>(positions_.size());
        positions_.push_back(node.position);
        radii_.push_back(node.radius);
        parents_.push_back(node.parent == kNoNode ? -1 : place[static_cast<size_t>(node.parent)]);
        flags_.push_back(node.flags);
    }
}

namespace {

nb::object json_of(const std::string& text) {
    return nb::module_::import_("json").attr("loads")(text);
}

// leaves: a preset's name, or auto. seed: nothing is the tree's own.
ExportOptions exports_of(const PythonTree& self, const std::string& leaves, std::optional<uint64_t> seed) {
    ExportOptions exports;
    exports.textures = leaves == "auto" ? self.leaves() : leaves;
    exports.leaves = suited_leaves(exports.textures, self.made());
    exports.foliage = self.made().foliage;
    exports.seed = seed.value_or(self.seed());
    return exports;
}

void write(const PythonTree& self, const std::filesystem::path& path, const std::string& leaves,
           std::optional<uint64_t> seed, int levels, bool pictures_beside, nb::object callback) {
    ExportOptions exports = exports_of(self, leaves, seed);
    exports.levels = levels;
    exports.pictures_beside = pictures_beside;
    PythonProgress progress(std::move(callback));
    without_lock(progress, [&] {
        require_writable_format(utf8_of(path));
        progress.update(0.0, "Writing");
        TreeExporter(self.tree(), exports, &progress).write(utf8_of(path));
        progress.update(1.0, "Writing");
        return true;
    });
}

template <typename T, typename Values>
nb::object attribute(Values&& values, size_t width) {
    const size_t count = values.size();
    return nb::cast(array_of<T>(std::forward<Values>(values), {count, width}));
}

// The arrays of treerec.Mesh, in its order.
nb::tuple mesh_of(const PythonTree& self, const std::string& leaves, std::optional<uint64_t> seed,
                  nb::object callback) {
    PythonProgress progress(std::move(callback));
    Mesh mesh = without_lock(progress, [&] {
        return TreeExporter(self.tree(), exports_of(self, leaves, seed), &progress).bark();
    });
    const size_t triangles = mesh.triangle_count();
    return nb::make_tuple(
        attribute<float>(std::move(mesh.positions), 3), attribute<float>(std::move(mesh.normals), 3),
        attribute<float>(std::move(mesh.tangents), 4), attribute<float>(std::move(mesh.uvs), 2),
        nb::cast(array_of<uint32_t>(std::move(mesh.indices), {triangles, 3})));
}

// The arrays of treerec.Leaves, in its order.
nb::tuple leaves_of(const PythonTree& self, const std::string& leaves, std::optional<uint64_t> seed,
                    nb::object callback) {
    PythonProgress progress(std::move(callback));
    const auto kinds = without_lock(progress, [&] {
        return TreeExporter(self.tree(), exports_of(self, leaves, seed), &progress).placed();
    });
    std::vector<Vec3> positions;
    std::vector<std::array<Vec3, 3>> axes;
    std::vector<float> sizes, hues;
    std::vector<uint8_t> kind_of;
    for (size_t kind = 0; kind < kinds.size(); kind++)
        for (const LeafPlacement& leaf : kinds[kind]) {
            positions.push_back(leaf.position);
            axes.push_back({leaf.x, leaf.y, leaf.z});
            sizes.push_back(leaf.size);
            hues.push_back(leaf.hue);
            kind_of.push_back(static_cast<uint8_t>(kind));
        }
    const size_t count = positions.size();
    return nb::make_tuple(attribute<float>(std::move(positions), 3),
                          nb::cast(array_of<float>(std::move(axes), {count, 3, 3})),
                          nb::cast(array_of<float>(std::move(sizes), {count})),
                          nb::cast(array_of<float>(std::move(hues), {count})),
                          nb::cast(array_of<uint8_t>(std::move(kind_of), {count})));
}

nb::object score(const PythonTree& self, const ScannedCloud& scan, double noise, double tolerance,
                 nb::object callback) {
    PythonProgress progress(std::move(callback));
    FidelityOptions options;
    options.tolerance = tolerance;
    return json_of(without_lock(progress, [&] {
        ScanReport report;
        progress.update(0.0, "Scoring");
        score_against_scan(report, self.tree(), scan.cloud, noise, options, 1, &progress);
        return scan_report_json(report, self.tree());
    }));
}

std::string lstring_of(const PythonTree& self, const std::string& dialect, double accuracy, bool flags) {
    LStringOptions options;
    options.dialect = parse_lstring_dialect(dialect);
    if (!(accuracy >= 1e-12 && accuracy <= 0.1)) throw Error("accuracy is a number from 1e-12 to 0.1.");
    options.accuracy = accuracy;
    options.radius_accuracy = std::min(10.0 * accuracy, 0.1);
    options.flags = flags;
    const nb::gil_scoped_release release;
    return lstring_file_text(write_lstring(self.tree(), self.tree().root(), options), self.tree().frame(),
                             options);
}

PythonTree read_tree(const std::filesystem::path& path, const std::string& up, size_t number,
                     const std::string& dialect) {
    SkeletonChoice choice(parse_up_axis(up), number);
    if (!dialect.empty()) choice.dialect = parse_lstring_dialect(dialect);
    const nb::gil_scoped_release release;
    Reconstruction made;
    SkeletonReport report;
    made.tree = read_skeleton(utf8_of(path), choice, &report);
    made.warnings = report.warnings;
    made.foliage = std::move(report.foliage);
    return {std::make_shared<const Reconstruction>(std::move(made)), "generic", 1};
}

nb::object scan_positions(const PythonTree& self) {
    std::vector<DVec3> places = self.positions();
    for (DVec3& place : places)
        place = self.tree().frame().to_scan(place);
    return attribute<double>(std::move(places), 3);
}

// The cleaned points that the tree was made of, in its own frame; none where it was not made of any.
nb::object cleaned_of(nb::handle_t<PythonTree> self) {
    const PointCloud& cloud = nb::cast<const PythonTree&>(self).made().cloud;
    if (cloud.empty()) return nb::none();
    return nb::cast(view_of(&cloud.positions[0].x, std::array{cloud.size(), size_t{3}}, self));
}

nb::object leaf_points_of(const PythonTree& self) {
    const Reconstruction& made = self.made();
    if (made.cloud.empty()) return nb::none();
    std::vector<uint8_t> leaf(made.cloud.size(), 0);
    for (size_t i = 0; i < made.wood.size(); i++)
        leaf[i] = made.wood[i] == 0;
    const size_t count = leaf.size();
    return nb::cast(array_of<bool>(std::move(leaf), {count}));
}

template <typename T>
nb::object row_of(nb::handle_t<PythonTree> self, const std::vector<T>& values) {
    return nb::cast(view_of(values.data(), std::array{values.size()}, self));
}

}  // namespace

void bind_tree(nb::module_& module) {
    nb::class_<PythonTree>(module, "Tree")
        .def("__len__", [](const PythonTree& self) { return self.tree().size(); })
        .def_prop_ro("positions",
                     [](nb::handle_t<PythonTree> self) {
                         const auto& places = nb::cast<const PythonTree&>(self).positions();
                         return nb::cast(view_of(&places[0].x, std::array{places.size(), size_t{3}}, self));
                     })
        .def_prop_ro("radii",
                     [](nb::handle_t<PythonTree> self) {
                         return row_of(self, nb::cast<const PythonTree&>(self).radii());
                     })
        .def_prop_ro("parents",
                     [](nb::handle_t<PythonTree> self) {
                         return row_of(self, nb::cast<const PythonTree&>(self).parents());
                     })
        .def_prop_ro("flags",
                     [](nb::handle_t<PythonTree> self) {
                         return row_of(self, nb::cast<const PythonTree&>(self).flags());
                     })
        .def_prop_ro("scan_positions", scan_positions)
        .def_prop_ro("origin",
                     [](const PythonTree& self) {
                         const DVec3& origin = self.tree().frame().origin;
                         return nb::make_tuple(origin.x, origin.y, origin.z);
                     })
        .def_prop_ro("up", [](const PythonTree& self) { return up_axis_name(self.tree().frame().up); })
        .def_prop_ro("metres_per_unit",
                     [](const PythonTree& self) { return self.tree().frame().metres_per_unit; })
        .def_prop_ro("warnings", [](const PythonTree& self) { return self.made().warnings; })
        .def_prop_ro("cleaned_points", cleaned_of)
        .def_prop_ro("cleaned_leaf", leaf_points_of)
        .def("report",
             [](const PythonTree& self) {
                 return self.report().empty() ? nb::none() : json_of(self.report());
             })
        .def("measure", [](const PythonTree& self) { return json_of(measurements_json(self.tree())); })
        .def("score", score, "scan"_a, "noise"_a, "tolerance"_a, "progress"_a.none())
        .def("write", write, "path"_a, "leaves"_a, "seed"_a.none(), "levels"_a, "pictures_beside"_a,
             "progress"_a.none())
        .def("mesh", mesh_of, "leaves"_a, "seed"_a.none(), "progress"_a.none())
        .def("leaves", leaves_of, "leaves"_a, "seed"_a.none(), "progress"_a.none())
        .def("lstring", lstring_of, "dialect"_a, "accuracy"_a, "flags"_a);
    module.def("read_tree", read_tree, "path"_a, "up"_a, "number"_a, "dialect"_a);
}

}  // namespace treerec

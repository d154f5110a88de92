// The library as Python sees it; python/treerec/__init__.py says it in Python's words.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <utility>

#include "cli/commands.h"
#include "cli/grow_from.h"
#include "cli/reconstruct_options.h"
#include "error.h"
#include "exchange/ready_pictures.h"
#include "foliage/leaf_rules.h"
#include "geometry/parallel.h"
#include "lsystem/grammar.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "python_cloud.h"
#include "python_progress.h"
#include "python_tree.h"
#include "version.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace treerec {

namespace {

using Words = std::vector<std::string>;

// "--no-clean" is no_clean here.
std::string in_python(std::string sentence) {
    for (size_t at = sentence.find("--"); at != std::string::npos; at = sentence.find("--", at)) {
        sentence.erase(at, 2);
        for (; at < sentence.size() &&
               (std::isalnum(static_cast<unsigned char>(sentence[at])) || sentence[at] == '-');
             at++)
            if (sentence[at] == '-') sentence[at] = '_';
    }
    return sentence;
}

// The command's arguments from words such as "--seed", "3". Throws Error for what is no such option.
Arguments arguments_from(const Command& command, const Words& words) {
    Arguments arguments(command, words);
    if (!arguments.positional().empty())
        throw UsageError("True and False are the values of switches, not " +
                         quote_word(arguments.positional()[0]) + ".");
    return arguments;
}

PythonTree reconstruct(const ScannedCloud& scan, const Words& words, nb::object callback) {
    ReconstructOptions options = reconstruct_options_from(arguments_from(reconstruct_command(), words));
    options.score_points = ReconstructOptions().score_points;
    PythonProgress progress(std::move(callback));
    std::string leaves, report;
    std::shared_ptr<const Reconstruction> made = without_lock(progress, [&] {
        SubProgress growing(&progress, 0.0, 0.95), scoring(&progress, 0.95, 1.0);
        Reconstruction result = reconstruct_cloud(scan.cloud, scan.read, scan.path, options, &growing);
        score_reconstruction(result, options, &scoring);
        result.raw = {};
        leaves = chosen_leaves("auto", result);
        ReportDetails details{scan.path, options, leaves, options.skeleton.seed, 0, 0};
        report = report_json(result, details);
        progress.update(1.0, "Score");
        return std::make_shared<const Reconstruction>(std::move(result));
    });
    return {std::move(made), leaves, options.skeleton.seed, std::move(report)};
}

PythonTree grow(const std::string& name, const std::string& text, const Words& words, nb::object callback) {
    const Arguments arguments = arguments_from(grow_command(), words);
    PythonProgress progress(std::move(callback));
    return without_lock(progress, [&] {
        progress.update(0.0, "Growing");
        const Grown grown = grow_from(name, text.empty() ? grammar_source(name) : text, arguments, progress);
        Reconstruction made;
        made.tree = grown.read.tree;
        made.foliage = foliage_of(grown, &progress);
        progress.update(1.0, "Growing");
        return PythonTree(std::make_shared<const Reconstruction>(std::move(made)),
                          grown.leaf_preset.empty() ? ExportOptions().textures : grown.leaf_preset,
                          grown.options.seed);
    });
}

Words option_names(const std::string& command) {
    Words names;
    for (const Option& option : (command == "grow" ? grow_command() : reconstruct_command()).options)
        names.push_back(option.name);
    return names;
}

void translate_usage(const std::exception_ptr& raised, void* error) {
    try {
        std::rethrow_exception(raised);
    } catch (const UsageError& usage) {
        PyErr_SetString(static_cast<PyObject*>(error), in_python(usage.what()).c_str());
    }
}

}  // namespace

}  // namespace treerec

NB_MODULE(_treerec, module) {
    using namespace treerec;
    // Python may end with trees still held by its modules.
    nb::set_leak_warnings(false);
    use_ready_pictures();
    const nb::exception<Error> error(module, "Error", PyExc_ValueError);
    nb::exception<Cancelled>(module, "Cancelled", error);
    nb::register_exception_translator(translate_usage, error.ptr());
    bind_cloud(module);
    bind_tree(module);
    module.attr("__version__") = kVersion;
    module.def("reconstruct", reconstruct, "scan"_a, "words"_a, "progress"_a.none());
    module.def("grow", grow, "name"_a, "text"_a, "words"_a, "progress"_a.none());
    module.def("option_names", option_names, "command"_a);
    module.def("leaf_presets", leaf_preset_names);
    module.def("grammars", grammar_preset_names);
    module.def("set_threads", set_thread_count, "threads"_a);
    module.def("end_idle_threads", end_idle_threads, nb::call_guard<nb::gil_scoped_release>());
}

// What TreeReconstructor tells of how true a tree is to its photos, and the page about it.
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "convert.h"
#include "error.h"
#include "file_bytes.h"
#include "photos/cameras_tell.h"
#include "pipeline/html_report.h"
#include "pipeline/show_fidelity.h"
#include "tree_reconstructor/scan_points.h"
#include "tree_reconstructor/tree_fidelity.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"
#include "tree_reconstructor/tree_reconstructor_photos.h"

using namespace godot;

std::string find_photo_model(const TreeReconstruction& p_tree, const String& p_model) {
    if (!p_model.is_empty()) {
        const std::string named = file_path(p_model);
        const std::vector<std::string> found =
            treerec::photo_models_beside(treerec::utf8_of(treerec::path_of(named) / "cloud.ply"));
        return found.empty() ? named : found.front();
    }
    const Dictionary provenance = p_tree.get_provenance();
    const String source = provenance.get("source", "");
    if (source.is_empty()) {
        throw treerec::Error(
            "This tree does not say what it was made of, so it is not known from where it was photographed. "
            "Choose the folder of its COLMAP model.");
    }
    const std::string scan = file_path(source);
    const std::vector<std::string> found = treerec::photo_models_beside(scan);
    if (found.empty()) {
        throw treerec::Error("Beside '" + scan +
                             "' there is no COLMAP model that would tell from where the tree was "
                             "photographed. Choose the folder of the model.");
    }
    return found.front();
}

static treerec::OutlineFolders to_folders(const TreeReconstruction& p_tree, const Dictionary& p_folders) {
    const auto folder = [&](const char* p_name) { return file_path(String(p_folders.get(p_name, ""))); };
    treerec::OutlineFolders folders;
    folders.model = find_photo_model(p_tree, String(p_folders.get("model", "")));
    folders.masks = folder("masks");
    folders.photos = folder("photos");
    if (folders.masks.empty() && folders.photos.empty()) {
        throw treerec::Error(
            "The photos themselves are not where they were, and there are no masks of them: nothing can "
            "judge "
            "the tree.");
    }
    return folders;
}

Dictionary TreeReconstructor::load_outlines(const Ref<TreeReconstruction>& p_tree,
                                            const PackedVector3Array& p_points, const Dictionary& p_folders) {
    Dictionary told;
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), told, "There is no tree whose photos could judge it.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), told, BUSY);
    try {
        Listener listener(this);
        listener.check();
        auto judge = std::make_shared<const treerec::PhotoJudge>(treerec::photo_judge(
            to_folders(**p_tree, p_folders), 0, to_cloud(p_tree->get_tree()->frame(), p_points), &listener));
        const treerec::PhotoFidelity& found = judge->cloud();
        told["judged_by"] = treerec::outline_source_name(judge->source());
        told["information"] = found.information;
        told["reconstruction"] = found.reconstruction;
        told["reconstruction_seen"] = found.seen;
        told["photos"] = list_hits(found);
        listener.check();
        const std::lock_guard lock(mutex_);
        judge_ = std::move(judge);
    } catch (const std::exception& error) {
        told = Dictionary();
        _fail(error.what());
    }
    return told;
}

// By the sky neither recall nor IoU is known.
static void add_overlap(const treerec::Overlap& p_overlap, bool p_masks, Dictionary& r_told) {
    r_told["precision"] = p_overlap.precision;
    if (p_masks) {
        r_told["recall"] = p_overlap.recall;
        r_told["iou"] = p_overlap.iou;
    }
}

Dictionary TreeReconstructor::measure_outline(const Ref<TreeReconstruction>& p_tree, bool p_leaves) {
    Dictionary told;
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), told, "There is no tree to measure.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), told, BUSY);
    try {
        Listener listener(this);
        listener.check();
        std::shared_ptr<const treerec::PhotoJudge> judge;
        {
            const std::lock_guard lock(mutex_);
            judge = judge_;
        }
        if (!judge) {
            throw treerec::Error("There are no photos to measure the tree with; call load_outlines() first.");
        }
        listener.update(0.0, "Outline");
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        const std::string look = to_std(p_tree->get_leaf_look());
        const std::vector<treerec::LeafKind> kinds =
            p_leaves ? p_tree->make_leaf_kinds(*tree)
                     : treerec::leaf_kinds(*tree, treerec::leaf_preset("none"));
        std::vector<treerec::OutlinePart> parts =
            treerec::outline_parts(*tree, kinds, look, uint64_t(p_tree->get_seed()),
                                   p_leaves ? *p_tree->get_leaf_density() : treerec::Foliage(), &listener);
        if (!p_leaves) {
            parts.resize(1);
        }
        listener.update(0.2, "Outline");
        const treerec::OutlineOverlap found = judge->judge(parts, tree->frame(), &listener);
        const bool masks = judge->source() == treerec::OutlineSource::kMasks;
        TypedArray<Dictionary> photos;
        for (const treerec::PhotoOverlap& photo : found.photos) {
            Dictionary entry;
            entry["name"] = to_godot(photo.name);
            add_overlap(photo.overlap, masks, entry);
            photos.push_back(entry);
        }
        add_overlap(found.mean, masks, told);
        told["photos"] = photos;
        listener.update(1.0, "Outline");
    } catch (const std::exception& error) {
        told = Dictionary();
        _fail(error.what());
    }
    return told;
}

Error TreeReconstructor::save_html_report(const String& p_path, const Dictionary& p_folders) {
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), ERR_BUSY, BUSY);
    try {
        Listener listener(this);
        listener.check();
        std::shared_ptr<const treerec::Reconstruction> result;
        treerec::ReportDetails details;
        {
            const std::lock_guard lock(mutex_);
            result = result_;
            details = *details_;
        }
        if (result->tree.empty()) {
            throw treerec::Error("There is nothing to report on; call reconstruct_file() first.");
        }
        const std::string path = file_path(p_path);
        treerec::require_writable(path);
        if (!p_folders.is_empty()) {
            treerec::ShowOptions show;
            show.name = treerec::stem_of(details.scan_path);
            show.leaves = treerec::suited_leaves(details.leaves, *result);
            show.textures = details.leaves;
            show.seed = details.seed;
            show.stages = false;
            const std::string scan = file_path(to_godot(details.scan_path));
            const std::vector<std::string> beside = treerec::photo_models_beside(scan);
            const String model = p_folders.get("model", "");
            if (model.is_empty() && beside.empty()) {
                throw treerec::Error("Beside '" + scan + "' there is no COLMAP model of the photos.");
            }
            show.photos = {model.is_empty() ? beside.front() : file_path(model),
                           file_path(String(p_folders.get("masks", ""))),
                           file_path(String(p_folders.get("photos", "")))};
            treerec::ShownFidelity shown = treerec::show_fidelity(*result, show, &listener);
            details.outline = std::move(shown.outline);
            details.outline_lacks = std::move(shown.lacks);
            details.outline_sheet = std::move(shown.fidelity);
        }
        treerec::write_file(path, treerec::report_html(*result, details, &listener), &listener);
        return OK;
    } catch (const std::exception& error) {
        _fail(error.what());
        return FAILED;
    }
}

#include "pipeline/html_photos.h"

#include "pipeline/histogram_svg.h"
#include "pipeline/html_parts.h"

namespace treerec {

namespace {

constexpr size_t kOpen = 12;  // more photos than these are unfolded by a click

std::string known(const Overlap* overlap, double Overlap::*share) {
    return overlap != nullptr ? with_bar(overlap->*share) : "-";
}

std::string photo_table(const OutlineJudgement& outline) {
    const bool sky = outline.source == OutlineSource::kSky;
    const std::vector<JudgedPhoto> photos = judged_photos(outline);
    std::string html = std::string("<details") + (photos.size() > kOpen ? "" : " open") + "><summary>" +
                       std::to_string(photos.size()) + (photos.size() == 1 ? " photo" : " photos") +
                       "</summary><div class=\"scroll\"><table><tr>";
    html += sky ? cells({"photo", "points not on the sky", "precision, at most"}, "th")
                : cells({"photo", "points on the tree", "recall", "precision", "IoU"}, "th");
    html += "</tr>";
    for (const JudgedPhoto& photo : photos) {
        const std::string name = words(photo.hits->name), points = with_bar(photo.hits->share);
        const std::string precision = known(photo.overlap, &Overlap::precision);
        html += "<tr>" +
                (sky ? cells({name, points, precision})
                     : cells({name, points, known(photo.overlap, &Overlap::recall), precision,
                              known(photo.overlap, &Overlap::iou)})) +
                "</tr>";
    }
    return html + "</table></div></details>";
}

}  // namespace

std::string photos_section(const ReportDetails& details, const Fidelity& fidelity) {
    if (!details.outline && details.outline_lacks.empty()) return "";
    std::string html = "<section><h2>Fidelity to the photos</h2>";
    if (!details.outline)
        return html + "<p>There is no Q: the photos do not judge this tree. " + words(details.outline_lacks) +
               "</p></section>";
    const OutlineJudgement& outline = *details.outline;
    const bool sky = outline.source == OutlineSource::kSky;
    const std::string most = sky ? ", at most" : "";
    const PhotoFidelity& photos = outline.cloud;
    const double q = photos.information * photos.reconstruction * fidelity.skeleton;
    html += "<div class=\"tiles\" style=\"margin:0 0 16px\">";
    html += tile(fixed(q, 3), "Q = I &middot; R<sub>3d</sub> &middot; R<sub>s</sub>" + most);
    html += tile(fixed(photos.information, 3), "I, what so many photos can tell");
    html += tile(fixed(photos.reconstruction, 3), "R<sub>3d</sub>, points on the tree" + most);
    html += tile(fixed(fidelity.skeleton, 3), "R<sub>s</sub>, points in the wood");
    html += tile(percent(outline.shapes.mean.precision), "outline precision" + most);
    html += tile(sky ? "not known" : percent(outline.shapes.mean.recall), "outline recall");
    html += tile(sky ? "not known" : percent(outline.shapes.mean.iou), "outline IoU");
    html += "</div><p>";
    html +=
        sky ? "<b>Precision only.</b> There are no masks of the photos, so their sky judges: what falls on "
              "the sky is wrong for sure, what falls on anything else counts as right. So R<sub>3d</sub>, Q "
              "and the precision are upper bounds, and what is missing from the tree (recall) is not seen."
            : "<b>Recall and precision</b> by masks of the photos: recall is the share of the mask that the "
              "tree covers, precision the share of the tree that lies on the mask, IoU what both cover of "
              "what either does.";
    html += outline.hold_out > 0 ? " The photos that judge were held out: the tree was not made of them."
                                 : " The tree was made of the photos that judge it, which flatters it.";
    html += " Of the points that each photo shows, " + percent(photos.seen) +
            (sky ? " are not on its sky." : " fall on the tree.") + "</p>";
    if (details.outline_sheet)
        html += "<div class=\"row\">" +
                figure(*details.outline_sheet, "From the front and from the side, as photos show it") +
                "</div>";
    return html + photo_table(outline) + "</section>";
}

}  // namespace treerec

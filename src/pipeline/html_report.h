// A reconstruction as one page to send to somebody.
#pragma once

#include <string>

#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "progress.h"

namespace treerec {

// report.html, UTF-8: one file that needs nothing else, neither net nor script. Pictures of the tree and of
// the fidelity by point from four sides (fidelity/fidelity.h, with its usual tolerance), of a tree of photos
// Q and what it is made of, with a table of the photos and the sheet of them, tables by order and
// by level of detail, histograms of radius and length by order, what is missing or doubtful, measurements,
// warnings and how it was made. Throws Error, or Cancelled.
std::string report_html(const Reconstruction& result, const ReportDetails& details,
                        Progress* progress = nullptr);

}  // namespace treerec

// What a page tells of a tree's photos. Internal to pipeline/.
#pragma once

#include <string>

#include "fidelity/fidelity.h"
#include "pipeline/report.h"

namespace treerec {

// Q and what it is made of, the photos that judge, and the sheet of them; where they
// can't judge, why; empty where there are none, or nobody asked them. fidelity: of the tree and the cloud's
// wood.
std::string photos_section(const ReportDetails& details, const Fidelity& fidelity);

}  // namespace treerec

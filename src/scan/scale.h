// How long a scan's unit is. Internal to scan/.
#pragma once

#include "scan/cleaning/clean_cloud.h"

namespace treerec {

// Sets the scale of `report` from the options, else guesses it, with a warning where that is not sure.
// height: of the cloud, in scan units. on_map: its coordinates are a map's. told: by its file, before any
// guess. Throws Error for bad options.
void set_scale(double height, bool on_map, const ScanUnit& told, const OrientOptions& options,
               OrientReport& report);

}  // namespace treerec

// What every step did, for who wants to recompute it. Internal to growth/.
#pragma once

#include <string>

#include "growth/surface.h"

namespace treerec::growth {

// Writes what a step's moves were, before splits, merges and flips, into two files of the folder, which must
// be there. step_00017.csv, a line per vertex: id,type,owner,x,y,z,vx,vy,vz,speed,pieces,tox,toy,toz,hold:
// type AM, CA or XY; owner: the branch; x y z: where it was (metres), v: equation 1's of the whole step, made
// in so many equal pieces; speed: S_c of equation 4 (metres a step); to: where it came to; hold: free, fold,
// surface or obstacle. step_00017_faces.csv, a line per face: the ids of its corners, counter-clockwise from
// outside. Throws Error where they can't be written. shortest: T_m, metres.
void write_trace(const std::string& folder, const Surface& surface, int step, double shortest);

}  // namespace treerec::growth

// The pictures that the build drew (src/drawer).
#pragma once

namespace treerec {

// Hands them to set_ready_pictures(); the build writes it.
void use_ready_pictures();

}  // namespace treerec

// How the program's memory comes from the system.
#pragma once

namespace treerec {

// Keeps what one stage frees for the next one, instead of giving it back and asking again, and has the first
// 64 MB come in huge pages where the kernel has some: small scans spent a tenth of their time on each.
// Nothing happens where the C library is not glibc. For a program that ends soon, at its start.
void keep_freed_memory();

}  // namespace treerec

#define TINYGLTF_IMPLEMENTATION
#include "exchange/quiet_tiny_gltf.h"

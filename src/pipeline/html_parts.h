// Pieces of a page. Internal to pipeline/.
#pragma once

#include <initializer_list>
#include <string>

#include "mesh/image.h"

namespace treerec {

const char* page_style();

// For HTML; bytes that are no UTF-8 are replaced.
std::string words(const std::string& text);
// caption: HTML.
std::string figure(const Image& image, const std::string& caption);
std::string percent(double share);
std::string millimetres(double metres);
std::string with_bar(double share);
// A row's cells; HTML.
std::string cells(std::initializer_list<std::string> values, const char* tag = "td");
std::string tile(const std::string& value, const std::string& name);

}  // namespace treerec

#pragma once

#include <list>

namespace godot {

// What _get_property_list() fills. Only the part of the engine's List that such a function needs.
template <typename T>
class List : public std::list<T> {
  public:
    using std::list<T>::list;
};

}  // namespace godot

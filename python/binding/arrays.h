// numpy arrays of what C++ holds.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace treerec {

template <typename T>
using InArray = nanobind::ndarray<const T, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;
template <typename T>
using OutArray = nanobind::ndarray<nanobind::numpy, const T>;

// Read-only, of the memory that `owner` holds and does not change; the array keeps the owner.
template <typename T, typename Shape>
OutArray<T> view_of(const T* data, const Shape& shape, nanobind::handle owner) {
    return OutArray<T>(data, std::size(shape), std::data(shape), owner);
}

// Of values that only the array has from now on.
template <typename T, typename Values>
nanobind::ndarray<nanobind::numpy, T> array_of(Values&& values, const std::vector<size_t>& shape) {
    auto kept = std::make_unique<std::decay_t<Values>>(std::forward<Values>(values));
    T* const data = reinterpret_cast<T*>(kept->data());
    using Kept = std::decay_t<Values>;
    const nanobind::capsule owner(kept.release(),
                                  [](void* memory) noexcept { delete static_cast<Kept*>(memory); });
    return nanobind::ndarray<nanobind::numpy, T>(data, shape.size(), shape.data(), owner);
}

}  // namespace treerec

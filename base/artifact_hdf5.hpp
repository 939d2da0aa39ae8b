// SPDX-License-Identifier: GPL-3.0-or-later
// What writer and reader of artifacts share of HDF5 with readers of other HDF5 files; nobody else
// includes this.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace meltproof {

/// An HDF5 identifier that is closed by the function that fits it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }
  bool reset() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || close_(id) >= 0;
  }
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// To be called before any other function of HDF5. It prints its error stack by default; our
/// sentences replace it. Nor may it tidy up as the program ends: every handle is closed by then,
/// and what a full disk left it with crashes it there. @returns true.
inline bool prepare_hdf5() {
  static const bool done = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  return done;
}

template <class T>
hid_t native_type();
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
inline hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
inline hid_t native_type<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
inline hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

inline std::vector<hsize_t> extent(const std::vector<std::size_t>& shape) {
  return {shape.begin(), shape.end()};
}

inline void write_text_attribute(hid_t object, const std::string& name, const std::string& value) {
  Handle type{H5Tcopy(H5T_C_S1), &H5Tclose};
  // HDF5 knows no text of length zero.
  H5Tset_size(type.get(), std::max<std::size_t>(1, value.size()));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  const Handle space{H5Screate(H5S_SCALAR), &H5Sclose};
  if (H5Aexists(object, name.c_str()) > 0) {
    H5Adelete(object, name.c_str());
  }
  const Handle attribute{
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      &H5Aclose};
  const std::string padded = value.empty() ? std::string(1, '\0') : value;
  if (!attribute.valid() || H5Awrite(attribute.get(), type.get(), padded.data()) < 0) {
    throw std::runtime_error("the attribute " + name + " cannot be written");
  }
}

inline std::string read_text_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) {
    return "";
  }
  const Handle attribute{H5Aopen(object, name.c_str(), H5P_DEFAULT), &H5Aclose};
  const Handle type{H5Aget_type(attribute.get()), &H5Tclose};
  const Handle space{H5Aget_space(attribute.get()), &H5Sclose};
  // A list of texts would be read beyond the memory of one, and no text is longer than a MiB.
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Tget_size(type.get()) > std::size_t{1} << 20) {
    return "";
  }
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    const Handle memory{H5Tcopy(H5T_C_S1), &H5Tclose};
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
    if (H5Aread(attribute.get(), memory.get(), static_cast<void*>(&text)) < 0 || text == nullptr) {
      return "";
    }
    std::string result(text);
    H5free_memory(text);
    return result;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    return "";
  }
  return text.substr(0, text.find('\0'));
}

}  // namespace meltproof

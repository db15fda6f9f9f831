// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_stream.h"
#include "plumbline/geometry/rectified_camera.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

namespace plumbline {

// Writes the state of a run as bytes (base/byte_format.h). Many parts of it share objects that
// never change: features, images, snapshots. Each object is written where it is met first; later a
// number stands for it, so that the parts share it again after reading.
class StateWriter : public ByteWriter {
 public:
  struct Place {
    std::uint64_t number = 0;  // order in which objects are met, from 1 on; 0: no object
    bool is_new = false;
  };
  // Returns the number of an object, which must live as long as the writer.
  Place PlaceOf(const void* object) {
    if (object == nullptr) return {};
    const auto [entry, is_new] = numbers_.try_emplace(object, numbers_.size() + 1);
    return {entry->second, is_new};
  }

 private:
  std::map<const void*, std::uint64_t> numbers_;
};

class StateReader : public ByteReader {
 public:
  // `camera` is the one with which all features were measured; their index is computed anew.
  StateReader(std::span<const std::uint8_t> bytes,
              std::string source,
              const RectifiedCamera& camera)
      : ByteReader(bytes, std::move(source)), camera_(camera) {}

  const RectifiedCamera& camera() const { return camera_; }

  // Whether this number stands for an object that follows now. If so, the object has its number
  // from now on.
  bool Begins(std::uint64_t number) {
    if (number != objects_.size() + 1) return false;
    objects_.emplace_back();
    return true;
  }
  template <class T>
  void Keep(std::uint64_t number, std::shared_ptr<const T> object) {
    objects_[static_cast<std::size_t>(number) - 1] = {&typeid(T), std::move(object)};
  }
  // Throws InputError for a number of no object, or of an object of another kind.
  template <class T>
  std::shared_ptr<const T> Known(std::uint64_t number) const {
    if (number == 0) return nullptr;
    if (number <= objects_.size()) {
      const Object& object = objects_[static_cast<std::size_t>(number) - 1];
      if (object.type != nullptr && *object.type == typeid(T)) {
        return std::static_pointer_cast<const T>(object.value);
      }
    }
    throw InputError(source() + ": expected something named before, found something else");
  }

 private:
  struct Object {
    const std::type_info* type = nullptr;
    std::shared_ptr<const void> value;
  };

  RectifiedCamera camera_;
  std::vector<Object> objects_;
};

template <class T>
void Transfer(StateWriter& archive, const std::shared_ptr<const T>& shared) {
  const auto [number, is_new] = archive.PlaceOf(shared.get());
  archive(number);
  if (is_new) Transfer(archive, *shared);
}
template <class T>
void Transfer(StateReader& archive, std::shared_ptr<const T>& shared) {
  std::uint64_t number = 0;
  archive(number);
  if (archive.Begins(number)) {
    auto object = std::make_shared<T>();
    Transfer(archive, *object);
    archive.Keep<T>(number, std::move(object));
  }
  shared = archive.Known<T>(number);
}

}  // namespace plumbline

#pragma once

#include <string>
#include <utility>

#include <hdf5.h>

// What every use of the HDF5 library needs: identifiers that close themselves, and errors that name the
// place.

namespace mpm::hdf5 {

/// Returns the library's own description of its last failure, from the place nearest to the cause, written as
/// " (TEXT)"; empty if there is none.
std::string last_error();

/// Turns off the messages of the library; ours replace them.
void silence_library();

/// A HDF5 identifier that is closed when it goes out of scope.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0)
      close_(id_);
  }

  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// The object being worked on, for messages and for the library: `name` in the group with the path `parent`.
struct Place {
  std::string file, what, parent, name;

  [[noreturn]] void fail(const std::string& problem) const;
  /// Throws InputError for a file of another program that cannot be read.
  [[noreturn]] void refuse(const std::string& found, const std::string& allowed) const;
  /// Calls fail() with the library's own description if `result` is an error.
  void check(herr_t result, const char* action) const;
  Handle own(hid_t id, Handle::Close close, const char* action) const;
};

}  // namespace mpm::hdf5

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/archive/hdf5_attributes.hpp"

namespace mpm {

namespace hdf5 {
struct GroupState;
}

/// A variable that is written row by row. A row is its values at one place of the first dimension. Rows go to
/// the file in blocks, so that at most one chunk waits in memory. Errors: as Hdf5Group.
template <class T>
class Hdf5Rows {
 public:
  /// Values in a row.
  std::size_t size() const;
  /// Returns room for one more row. Fill it before the next call.
  T* add();
  /// Writes the rows that wait. The number of rows added must be the length of the dimension.
  void finish();

 private:
  friend class Hdf5Group;
  struct State;

  explicit Hdf5Rows(std::shared_ptr<State> state) : state_(std::move(state)) {}

  std::shared_ptr<State> state_;
};

/// A group of an HDF5 file that netCDF-4 can read too.
///
/// Every variable has named dimensions. A dimension is a one-dimensional variable of the same group that
/// holds the coordinates. It is an HDF5 dimension scale and is attached to each variable that has the
/// dimension.
///
/// T is one of std::int8_t, std::int32_t, std::int64_t, double and std::string (variable-length UTF-8;
/// invalid UTF-8 is replaced, see proper_utf8()). Values of several dimensions are stored row by row, the
/// last index fastest. Large variables are compressed. Doubles that are not coordinates have the fill value
/// NaN.
///
/// All members throw ArchiveError, whose text names the file and the object.
class Hdf5Group {
 public:
  /// Creates a group in this one.
  Hdf5Group create_group(const std::string& name);

  void write_attribute(const std::string& name, const AttributeValue& value);

  /// Writes a new dimension with its coordinates.
  template <class T>
  void write_dimension(const std::string& name, const std::vector<T>& coordinates,
                       const Attributes& attributes);

  /// Creates a dimension with `length` coordinates, which are written later, one a row.
  template <class T>
  Hdf5Rows<T> create_dimension(const std::string& name, std::size_t length, const Attributes& attributes);

  /// Writes a new variable over dimensions of this group; without dimensions it has one value. The number of
  /// values must be the product of the lengths of the dimensions.
  template <class T>
  void write(const std::string& name, const std::vector<std::string>& dimensions,
             const std::vector<T>& values, const Attributes& attributes);

  /// Creates a variable whose values are written later, row by row.
  template <class T>
  Hdf5Rows<T> create_rows(const std::string& name, const std::vector<std::string>& dimensions,
                          const Attributes& attributes);

  bool has_group(const std::string& name) const;
  /// Opens a group in this one.
  Hdf5Group group(const std::string& name) const;

  bool has_attribute(const std::string& name) const;
  /// T is one of the types that an attribute can hold, and must be the type in the file.
  template <class T>
  T attribute(const std::string& name) const;

  /// Returns all values of a variable. T must be the type in the file, and `shape` the lengths of its
  /// dimensions.
  template <class T>
  std::vector<T> read(const std::string& name, const std::vector<std::size_t>& shape) const;

  /// Returns `count` rows of a variable, from row `first` on. A row is its values at one place of the first
  /// dimension.
  template <class T>
  std::vector<T> read_rows(const std::string& name, const std::vector<std::size_t>& shape, std::size_t first,
                           std::size_t count) const;

  /// Returns all values of a one-dimensional variable of any length.
  template <class T>
  std::vector<T> read_list(const std::string& name) const;

  // The members below read files of other programs, whatever types these chose. They throw InputError if
  // something cannot be read: a variable whose values HDF5 would read from another file (external storage, an
  // external link, a virtual variable), a variable of more than 400 MB, or values or attributes of another
  // type.

  /// Names of the variables of this group, in alphabetical order.
  std::vector<std::string> variables() const;
  /// The lengths of the dimensions of a variable.
  std::vector<std::size_t> shape(const std::string& variable) const;
  /// The names of the dimensions of a variable: its own name if it is a coordinate variable, empty for a
  /// dimension without a name.
  std::vector<std::string> dimensions(const std::string& variable) const;
  bool is_number(const std::string& variable) const;
  bool is_text(const std::string& variable) const;
  /// All values of a variable of any number type, row by row.
  std::vector<double> numbers(const std::string& variable) const;
  /// All values of a variable of texts of fixed or variable length.
  std::vector<std::string> texts(const std::string& variable) const;
  /// Names of the groups in this one, in alphabetical order.
  std::vector<std::string> groups() const;
  bool is_reference(const std::string& variable) const;
  /// The paths of the objects that the values of a variable refer to. Other members accept these paths. A
  /// path is empty if the value refers to nothing.
  std::vector<std::string> references(const std::string& variable) const;
  /// An attribute of a variable, if it has it. An attribute of another type or with several values is
  /// refused.
  std::optional<double> number_attribute(const std::string& variable, const std::string& name) const;
  std::optional<std::string> text_attribute(const std::string& variable, const std::string& name) const;

 private:
  friend class Hdf5File;
  using State = hdf5::GroupState;
  struct Scales;

  explicit Hdf5Group(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// An HDF5 file that is being written, in memory or on the disk, or read.
///
/// The library leaves a broken file behind if the disk is full or the process is killed. Therefore
/// write_file_atomically() puts a file in its place: the finished image, or the temporary file that was
/// written on the disk. The file holds no time stamps: the same content gives the same bytes. It is read only
/// after its seal (results/files/file_seal.hpp) has shown that it is what was written.
class Hdf5File {
 public:
  /// Creates an empty file in memory. `name` is for messages.
  static Hdf5File create(const std::string& name);

  /// Replaces the file at `path`, which must exist, by an empty one; call finish() at the end.
  static Hdf5File create_at(const std::filesystem::path& path, const std::string& name);

  /// Opens a file for reading. Throws ArchiveError if it is no HDF5 file, incomplete, or damaged.
  static Hdf5File open(const std::filesystem::path& path);

  /// Opens the content of a file that another program has written without a seal. The library notices damage
  /// to such a file in few places only. `name` is for messages. Throws ArchiveError if it is no HDF5 file.
  static Hdf5File open_unsealed(std::vector<std::byte> content, const std::string& name);

  /// The group that holds everything.
  Hdf5Group root() const;

  /// Writes everything to the disk. Throws ArchiveError if that fails. The file is closed when its last group
  /// is destroyed.
  void finish() const;

  /// The bytes of the file so far, with their seal.
  std::vector<std::byte> image() const;

 private:
  explicit Hdf5File(std::shared_ptr<const Hdf5Group::State> root) : root_(std::move(root)) {}

  std::shared_ptr<const Hdf5Group::State> root_;
};

}  // namespace mpm

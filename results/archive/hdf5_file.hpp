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

/// A variable that is written row by row, a row being its values at one place of the first dimension, and
/// goes to the file in blocks: what waits is a chunk at most. Errors: as Hdf5Group.
template <class T>
class Hdf5Rows {
 public:
  /// Values in a row.
  std::size_t size() const;
  /// Room for one more row, which is to be filled before the next call.
  T* add();
  /// Writes what waits. As many rows must have been added as the dimension is long.
  void finish();

 private:
  friend class Hdf5Group;
  struct State;

  explicit Hdf5Rows(std::shared_ptr<State> state) : state_(std::move(state)) {}

  std::shared_ptr<State> state_;
};

/// A group of an HDF5 file that netCDF-4 can read too.
///
/// Every variable has named dimensions. A dimension is a one-dimensional variable of the same group, its
/// coordinates, made an HDF5 dimension scale and attached to each variable that has it.
///
/// T is one of std::int8_t, std::int32_t, std::int64_t, double and std::string (variable-length UTF-8; what
/// is no UTF-8 is replaced, see proper_utf8()). Values of several dimensions stand row by row, the last index
/// fastest. Large variables are compressed; doubles that are no coordinates have the fill value NaN.
///
/// All members throw ArchiveError, whose text names the file and the object.
class Hdf5Group {
 public:
  /// A new group in this one.
  Hdf5Group create_group(const std::string& name);

  void write_attribute(const std::string& name, const AttributeValue& value);

  /// A new dimension with its coordinates.
  template <class T>
  void write_dimension(const std::string& name, const std::vector<T>& coordinates,
                       const Attributes& attributes);

  /// The same with as many coordinates as `length`, which come later, one a row.
  template <class T>
  Hdf5Rows<T> create_dimension(const std::string& name, std::size_t length, const Attributes& attributes);

  /// A new variable over dimensions of this group; none of them: one value. The number of values must be the
  /// product of the lengths of the dimensions.
  template <class T>
  void write(const std::string& name, const std::vector<std::string>& dimensions,
             const std::vector<T>& values, const Attributes& attributes);

  /// The same with values that come later, row by row.
  template <class T>
  Hdf5Rows<T> create_rows(const std::string& name, const std::vector<std::string>& dimensions,
                          const Attributes& attributes);

  bool has_group(const std::string& name) const;
  /// A group in this one.
  Hdf5Group group(const std::string& name) const;

  bool has_attribute(const std::string& name) const;
  /// T is one of the types that an attribute can hold, and must be the type in the file.
  template <class T>
  T attribute(const std::string& name) const;

  /// All values of a variable. T must be the type in the file, `shape` the lengths of its dimensions.
  template <class T>
  std::vector<T> read(const std::string& name, const std::vector<std::size_t>& shape) const;

  /// The same of `count` rows from the row `first` on, a row being the values at one place of the first
  /// dimension.
  template <class T>
  std::vector<T> read_rows(const std::string& name, const std::vector<std::size_t>& shape, std::size_t first,
                           std::size_t count) const;

  /// All values of a variable of one dimension, whatever its length is.
  template <class T>
  std::vector<T> read_list(const std::string& name) const;

  // Of files that others have written, whatever types they chose. These throw InputError for what cannot be
  // read: a variable whose values HDF5 would read in another file (external storage, an external link, a
  // virtual variable), one of more than 400 MB, and values or attributes of another type:

  /// Names of the variables of this group, in the order of the alphabet.
  std::vector<std::string> variables() const;
  /// The lengths of the dimensions of a variable.
  std::vector<std::size_t> shape(const std::string& variable) const;
  /// The names of its dimensions; the name of the variable itself of coordinates, empty where it has none.
  std::vector<std::string> dimensions(const std::string& variable) const;
  bool is_number(const std::string& variable) const;
  bool is_text(const std::string& variable) const;
  /// All values, row by row, of whatever number type.
  std::vector<double> numbers(const std::string& variable) const;
  /// All values of texts of fixed or variable length.
  std::vector<std::string> texts(const std::string& variable) const;
  /// Names of the groups in this one, in the order of the alphabet.
  std::vector<std::string> groups() const;
  bool is_reference(const std::string& variable) const;
  /// The paths of the objects that the values of a variable refer to, by which other members take them;
  /// empty: none.
  std::vector<std::string> references(const std::string& variable) const;
  /// An attribute of a variable; none when there is none. One of another kind, or with several values, is
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

/// An HDF5 file that is made, in memory or on the disk, or read.
///
/// The library leaves wreckage behind when a disk is full or it is killed, so that a file is put in its place
/// by write_file_atomically(): the finished image, or the temporary file that was made on the disk. It holds
/// no time stamps: the same content is the same bytes. It is read after its seal
/// (results/files/file_seal.hpp) has shown that it is what was written.
class Hdf5File {
 public:
  /// An empty file in memory. `name` is for messages.
  static Hdf5File create(const std::string& name);

  /// An empty file instead of the one at `path`, which must be there; finish() ends it.
  static Hdf5File create_at(const std::filesystem::path& path, const std::string& name);

  /// Opens a file for reading. Throws ArchiveError when it is no HDF5 file, not a whole one, or damaged.
  static Hdf5File open(const std::filesystem::path& path);

  /// The content of a file that somebody else has written and nothing has sealed: the library notices damage
  /// of it in few places only. `name` is for messages. Throws ArchiveError when it is no HDF5 file.
  static Hdf5File open_unsealed(std::vector<std::byte> content, const std::string& name);

  /// The group that holds everything.
  Hdf5Group root() const;

  /// Writes everything to the disk. Throws ArchiveError when that fails. The file is closed when the last
  /// group of it is gone.
  void finish() const;

  /// The bytes of the file so far, with their seal.
  std::vector<std::byte> image() const;

 private:
  explicit Hdf5File(std::shared_ptr<const Hdf5Group::State> root) : root_(std::move(root)) {}

  std::shared_ptr<const Hdf5Group::State> root_;
};

}  // namespace mpm

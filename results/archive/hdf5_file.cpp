#include "results/archive/hdf5_file.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include "plants/non_finite.hpp"
#include "results/archive/disk_file.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/file_seal.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

// --- Handles and errors -----------------------------------------------------------------------------------

/// The library's own account of its last failure, from the place nearest to the cause.
std::string last_error() {
  std::string text;
  const auto keep = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    auto& kept = *static_cast<std::string*>(data);
    if (kept.empty() && error->desc != nullptr)
      kept = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep, &text);
  return text.empty() ? "no reason given" : text;
}

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

/// The object at hand, for messages and for the library: `name` in the group with the path `parent`.
struct Place {
  std::string file, what, parent, name;

  [[noreturn]] void fail(const std::string& problem) const {
    throw ArchiveError(fmt::format("{}: {} '{}{}': {}", file, what, parent, name, problem));
  }
  void check(herr_t result, const char* action) const {
    if (result < 0)
      fail(fmt::format("cannot {} ({})", action, last_error()));
  }
  Handle own(hid_t id, Handle::Close close, const char* action) const {
    if (id < 0)
      fail(fmt::format("cannot {} ({})", action, last_error()));
    return {id, close};
  }
};

/// Our messages take the place of the library's.
void silence_library() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// --- Types ------------------------------------------------------------------------------------------------

Handle string_type(const Place& place) {
  Handle type = place.own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  place.check(H5Tset_size(type.get(), H5T_VARIABLE), "make a type");
  place.check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "make a type");
  return type;
}

template <class T>
Handle type_of(const Place& place) {
  if constexpr (std::is_same_v<T, std::string>)
    return string_type(place);
  const hid_t type = std::is_same_v<T, double>          ? H5T_IEEE_F64LE
                     : std::is_same_v<T, std::int8_t>   ? H5T_STD_I8LE
                     : std::is_same_v<T, std::int32_t>  ? H5T_STD_I32LE
                     : std::is_same_v<T, std::int64_t>  ? H5T_STD_I64LE
                     : std::is_same_v<T, std::uint64_t> ? H5T_STD_U64LE
                                                        : H5I_INVALID_HID;
  return place.own(H5Tcopy(type), H5Tclose, "make a type");
}

template <class T>
void require_type(const Place& place, hid_t found) {
  bool same = false;
  if constexpr (std::is_same_v<T, std::string>)
    same = H5Tget_class(found) == H5T_STRING && H5Tis_variable_str(found) > 0;
  else
    same = H5Tequal(found, type_of<T>(place).get()) > 0;
  if (!same)
    place.fail("another type of values than expected");
}

// --- Values -----------------------------------------------------------------------------------------------

/// Calls write(buffer) with the values as the library takes them.
template <class T, class Write>
void with_buffer(const std::vector<T>& values, Write write) {
  if constexpr (std::is_same_v<T, std::string>) {
    std::vector<std::string> texts(values.size());
    std::transform(values.begin(), values.end(), texts.begin(), proper_utf8);
    std::vector<const char*> pointers(values.size());
    std::transform(texts.begin(), texts.end(), pointers.begin(),
                   [](const std::string& text) { return text.c_str(); });
    write(pointers.data());
  } else {
    write(values.data());
  }
}

/// `count` values, which read(buffer) gets from the library in memory that it may allocate.
template <class T, class Read>
std::vector<T> from_buffer(std::size_t count, hid_t type, hid_t space, Read read) {
  if constexpr (std::is_same_v<T, std::string>) {
    struct Texts {
      hid_t type, space;
      std::vector<char*> pointers;
      ~Texts() { H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data()); }
    } texts{type, space, std::vector<char*>(count, nullptr)};
    read(texts.pointers.data());
    std::vector<std::string> values(count);
    std::transform(texts.pointers.begin(), texts.pointers.end(), values.begin(),
                   [](const char* text) { return text == nullptr ? std::string() : std::string(text); });
    return values;
  } else {
    std::vector<T> values(count);
    read(values.data());
    return values;
  }
}

using Shape = std::vector<hsize_t>;

std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

Handle make_space(const Place& place, const Shape& shape) {
  return place.own(shape.empty() ? H5Screate(H5S_SCALAR)
                                 : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose, "make a space");
}

Shape shape_of(const Place& place, hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  place.check(rank, "read the shape");
  Shape shape(static_cast<std::size_t>(rank));
  place.check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "read the shape");
  return shape;
}

// --- Attributes -------------------------------------------------------------------------------------------

template <class T>
void write_attribute_values(const Place& place, hid_t object, const Shape& shape,
                            const std::vector<T>& values) {
  const Handle type = type_of<T>(place);
  const Handle space = make_space(place, shape);
  const Handle attribute =
      place.own(H5Acreate2(object, place.name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose, "create it");
  if (!values.empty())
    with_buffer(values, [&](const void* buffer) {
      place.check(H5Awrite(attribute.get(), type.get(), buffer), "write it");
    });
}

void write_attribute_to(const Place& place, hid_t object, const AttributeValue& value) {
  std::visit(
      [&]<class V>(const V& v) {
        if constexpr (std::is_arithmetic_v<V> || std::is_same_v<V, std::string>)
          write_attribute_values<V>(place, object, {}, {v});
        else
          write_attribute_values(place, object, {v.size()}, v);
      },
      value);
}

template <class T>
std::vector<T> read_attribute_values(const Place& place, hid_t object) {
  if (H5Aexists(object, place.name.c_str()) <= 0)
    place.fail("missing");
  const Handle attribute = place.own(H5Aopen(object, place.name.c_str(), H5P_DEFAULT), H5Aclose, "open it");
  const Handle type = place.own(H5Aget_type(attribute.get()), H5Tclose, "read its type");
  require_type<T>(place, type.get());
  const Handle space = place.own(H5Aget_space(attribute.get()), H5Sclose, "read its shape");
  const std::size_t count = product(shape_of(place, space.get()));
  return from_buffer<T>(count, type.get(), space.get(), [&](void* buffer) {
    if (count > 0)
      place.check(H5Aread(attribute.get(), type.get(), buffer), "read it");
  });
}

// --- Variables --------------------------------------------------------------------------------------------

constexpr unsigned kTrackOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
constexpr double kFillValue = kNaN;
constexpr std::size_t kCompressFromBytes = 4096;
constexpr unsigned kCompressionLevel = 4;

/// Whole rows of the first dimension, as many as give a chunk of about kChunkValues values.
Shape chunk_shape(const Shape& shape) {
  Shape chunk = shape;
  const hsize_t row = std::max<hsize_t>(1, product(shape) / shape.front());
  chunk.front() = std::clamp<hsize_t>(kChunkValues / row, 1, shape.front());
  return chunk;
}

template <class T>
Handle creation_properties(const Place& place, const Shape& shape, bool fill) {
  Handle properties = place.own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make properties");
  const hid_t id = properties.get();
  place.check(H5Pset_obj_track_times(id, false), "make properties");
  place.check(H5Pset_attr_creation_order(id, kTrackOrder), "make properties");
  // Texts are stored apart from the variable, where compression does not reach.
  if (!std::is_same_v<T, std::string> && !shape.empty() && product(shape) * sizeof(T) >= kCompressFromBytes) {
    const Shape chunk = chunk_shape(shape);
    place.check(H5Pset_chunk(id, static_cast<int>(chunk.size()), chunk.data()), "make properties");
    place.check(H5Pset_shuffle(id), "make properties");
    place.check(H5Pset_deflate(id, kCompressionLevel), "make properties");
  }
  if (fill)
    place.check(H5Pset_fill_value(id, H5T_NATIVE_DOUBLE, &kFillValue), "make properties");
  return properties;
}

/// A variable without values. It keeps no chunk in memory: whole ones are written.
template <class T>
Handle create_dataset(const Place& place, hid_t group, const Shape& shape, const Attributes& attributes,
                      bool is_dimension) {
  const bool fill = std::is_same_v<T, double> && !is_dimension;
  const Handle type = type_of<T>(place);
  const Handle space = make_space(place, shape);
  const Handle properties = creation_properties<T>(place, shape, fill);
  const Handle access = place.own(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, "make properties");
  place.check(H5Pset_chunk_cache(access.get(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, H5D_CHUNK_CACHE_W0_DEFAULT),
              "make properties");
  Handle dataset = place.own(H5Dcreate2(group, place.name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                        properties.get(), access.get()),
                             H5Dclose, "create it");
  if (fill)
    write_attribute_to({place.file, "attribute", place.parent + place.name + "/", "_FillValue"},
                       dataset.get(), kFillValue);
  for (const auto& [name, value] : attributes)
    write_attribute_to({place.file, "attribute", place.parent + place.name + "/", name}, dataset.get(),
                       value);
  return dataset;
}

template <class T>
Handle write_dataset(const Place& place, hid_t group, const Shape& shape, const std::vector<T>& values,
                     const Attributes& attributes, bool is_dimension) {
  assert(values.size() == product(shape));
  Handle dataset = create_dataset<T>(place, group, shape, attributes, is_dimension);
  const Handle type = type_of<T>(place);
  if (!values.empty())
    with_buffer(values, [&](const void* buffer) {
      place.check(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer), "write it");
    });
  return dataset;
}

/// Of a group, or of a file for its root group. Without times, so that the same content is the same bytes.
void set_group_properties(const Place& place, hid_t properties) {
  place.check(H5Pset_obj_track_times(properties, false), "make properties");
  place.check(H5Pset_link_creation_order(properties, kTrackOrder), "make properties");
  place.check(H5Pset_attr_creation_order(properties, kTrackOrder), "make properties");
}

Handle open_dataset(const Place& place, hid_t group) {
  if (H5Lexists(group, place.name.c_str(), H5P_DEFAULT) <= 0)
    place.fail("missing");
  return place.own(H5Dopen2(group, place.name.c_str(), H5P_DEFAULT), H5Dclose, "open it");
}

Shape shape_of_dataset(const Place& place, const Handle& dataset) {
  const Handle space = place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape");
  return shape_of(place, space.get());
}

/// A variable that has this shape.
Handle open_dataset(const Place& place, hid_t group, const std::vector<std::size_t>& shape) {
  Handle dataset = open_dataset(place, group);
  const Shape found = shape_of_dataset(place, dataset);
  if (!std::equal(found.begin(), found.end(), shape.begin(), shape.end()))
    place.fail(
        fmt::format("shape ({}) where ({}) is expected", fmt::join(found, ", "), fmt::join(shape, ", ")));
  return dataset;
}

/// The space of a variable of this shape with `count` rows from `first` on chosen.
Handle rows_of_space(const Place& place, const Shape& shape, hsize_t first, hsize_t count) {
  Handle space = make_space(place, shape);
  Shape begin(shape.size(), 0), size = shape;
  begin.front() = first;
  size.front() = count;
  place.check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr, size.data(), nullptr),
              "select rows of it");
  return space;
}

/// What is chosen in the space of a variable.
template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset, const Handle& chosen) {
  const Handle type = place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type");
  require_type<T>(place, type.get());
  const auto count = static_cast<hsize_t>(H5Sget_select_npoints(chosen.get()));
  const Handle here = make_space(place, {count});
  return from_buffer<T>(count, type.get(), here.get(), [&](void* buffer) {
    if (count > 0)
      place.check(H5Dread(dataset.get(), type.get(), here.get(), chosen.get(), H5P_DEFAULT, buffer),
                  "read it");
  });
}

template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset) {
  return read_dataset<T>(place, dataset, place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape"));
}

// --- Files on the disk ------------------------------------------------------------------------------------

/// The driver of a file that is made on the disk. The library crashes when it ends with a file that it could
/// not write, so that it hears of no error; finish() tells.
struct DiskDriver {
  H5FD_t base = {};  ///< first, as the library wants it
  DiskFile disk;
  haddr_t end_of_allocation = 0, end_of_file = 0;

  static DiskDriver& of(H5FD_t* file) { return *reinterpret_cast<DiskDriver*>(file); }
  static const DiskDriver& of(const H5FD_t* file) { return *reinterpret_cast<const DiskDriver*>(file); }

  DiskDriver(const char* path, int* error) : disk(path, error) {}

  static H5FD_t* open(const char* name, unsigned, hid_t access, haddr_t) {
    auto* const error = *static_cast<int* const*>(H5Pget_driver_info(access));
    auto file = std::make_unique<DiskDriver>(name, error);
    return file->disk.is_open() ? &file.release()->base : nullptr;
  }
  static herr_t close(H5FD_t* file) {
    const std::unique_ptr<DiskDriver> closed(&of(file));
    return 0;
  }
  static herr_t query(const H5FD_t*, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
  }
  static haddr_t get_eoa(const H5FD_t* file, H5FD_mem_t) { return of(file).end_of_allocation; }
  static herr_t set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    of(file).end_of_allocation = end;
    return 0;
  }
  static haddr_t get_eof(const H5FD_t* file, H5FD_mem_t) { return of(file).end_of_file; }

  static herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, void* buffer) {
    of(file).disk.read(begin, {static_cast<char*>(buffer), size});
    return 0;
  }
  static herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, const void* buffer) {
    DiskDriver& to = of(file);
    to.disk.write(begin, {static_cast<const char*>(buffer), size});
    to.end_of_file = std::max<haddr_t>(to.end_of_file, begin + size);
    return 0;
  }
  static herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
    DiskDriver& cut = of(file);
    if (cut.end_of_file != cut.end_of_allocation)
      cut.disk.truncate(cut.end_of_allocation);
    cut.end_of_file = cut.end_of_allocation;
    return 0;
  }

  /// The driver of such files, known to the library from the first call on.
  static hid_t driver() {
    static const H5FD_class_t kClass = [] {
      H5FD_class_t driver{};
      driver.name = "mpmbench disk";
      driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
      driver.fc_degree = H5F_CLOSE_WEAK;
      driver.fapl_size = sizeof(int*);
      driver.open = open;
      driver.close = close;
      driver.query = query;
      driver.get_eoa = get_eoa;
      driver.set_eoa = set_eoa;
      driver.get_eof = get_eof;
      driver.read = read;
      driver.write = write;
      driver.truncate = truncate;
      constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;
      std::copy(std::begin(kMap), std::end(kMap), std::begin(driver.fl_map));
      return driver;
    }();
    static const hid_t kDriver = H5FDregister(&kClass);
    return kDriver;
  }
};

}  // namespace

// --- Groups -----------------------------------------------------------------------------------------------

/// The library keeps a file open while a group of it is, so that the root group stands for the file.
struct Hdf5Group::State {
  DiskError disk;  ///< of a file that is made on the disk; it is closed with the last group
  Handle group;
  std::string file;
  std::string path;  ///< ends with "/"

  Place place(const char* what, const std::string& name) const { return {file, what, path, name}; }

  static std::shared_ptr<const State> root_of(const Handle& file, const Place& place, DiskError disk = {}) {
    return std::make_shared<const State>(State{
        std::move(disk), place.own(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "open the root group"),
        place.file, place.parent});
  }
};

/// The dimensions of a variable to come, in its group.
struct Hdf5Group::Scales {
  std::vector<Handle> datasets = {};
  Shape shape = {};

  Scales(const State& group, const std::vector<std::string>& dimensions) {
    for (const std::string& dimension : dimensions) {
      const Place place = group.place("dimension", dimension);
      datasets.push_back(open_dataset(place, group.group.get()));
      shape.push_back(shape_of_dataset(place, datasets.back()).at(0));
    }
  }

  void attach_to(const Handle& variable, const Place& place) const {
    for (std::size_t i = 0; i < datasets.size(); ++i)
      place.check(H5DSattach_scale(variable.get(), datasets[i].get(), static_cast<unsigned>(i)),
                  "attach its dimensions");
  }
};

Hdf5Group Hdf5Group::create_group(const std::string& name) {
  const Place place = state_->place("group", name);
  const Handle properties = place.own(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "make properties");
  set_group_properties(place, properties.get());
  return Hdf5Group(std::make_shared<const State>(State{
      state_->disk,
      place.own(H5Gcreate2(state_->group.get(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                H5Gclose, "create it"),
      state_->file, state_->path + name + "/"}));
}

void Hdf5Group::write_attribute(const std::string& name, const AttributeValue& value) {
  write_attribute_to(state_->place("attribute", name), state_->group.get(), value);
}

template <class T>
void Hdf5Group::write_dimension(const std::string& name, const std::vector<T>& coordinates,
                                const Attributes& attributes) {
  const Place place = state_->place("dimension", name);
  const Handle dataset =
      write_dataset(place, state_->group.get(), {coordinates.size()}, coordinates, attributes, true);
  place.check(H5DSset_scale(dataset.get(), name.c_str()), "make it a dimension");
}

template <class T>
void Hdf5Group::write(const std::string& name, const std::vector<std::string>& dimensions,
                      const std::vector<T>& values, const Attributes& attributes) {
  const Place place = state_->place("variable", name);
  const Scales scales(*state_, dimensions);
  const Handle dataset = write_dataset(place, state_->group.get(), scales.shape, values, attributes, false);
  scales.attach_to(dataset, place);
}

template <class T>
Hdf5Rows<T> Hdf5Group::create_rows(const std::string& name, const std::vector<std::string>& dimensions,
                                   const Attributes& attributes) {
  const Place place = state_->place("variable", name);
  const Scales scales(*state_, dimensions);
  Handle dataset = create_dataset<T>(place, state_->group.get(), scales.shape, attributes, false);
  scales.attach_to(dataset, place);
  return Hdf5Rows<T>(std::make_shared<typename Hdf5Rows<T>::State>(place, std::move(dataset), scales.shape));
}

template <class T>
Hdf5Rows<T> Hdf5Group::create_dimension(const std::string& name, std::size_t length,
                                        const Attributes& attributes) {
  const Place place = state_->place("dimension", name);
  Handle dataset = create_dataset<T>(place, state_->group.get(), {length}, attributes, true);
  place.check(H5DSset_scale(dataset.get(), name.c_str()), "make it a dimension");
  return Hdf5Rows<T>(std::make_shared<typename Hdf5Rows<T>::State>(place, std::move(dataset), Shape{length}));
}

// --- Variables that are written row by row ----------------------------------------------------------------

template <class T>
struct Hdf5Rows<T>::State {
  Place place;
  Handle dataset;
  Shape shape;
  std::size_t row;      ///< values in one
  std::size_t block;    ///< rows that are written at once
  hsize_t written = 0;  ///< rows
  std::vector<T> waiting = {};

  State(Place at, Handle of, Shape size)
      : place(std::move(at)),
        dataset(std::move(of)),
        shape(std::move(size)),
        row(product({shape.begin() + 1, shape.end()})),
        block(row == 0 || shape.front() == 0 ? 1 : chunk_shape(shape).front()) {}

  void write() {
    if (waiting.empty())
      return;
    const hsize_t count = waiting.size() / row;
    const Handle type = type_of<T>(place), there = rows_of_space(place, shape, written, count),
                 here = make_space(place, {waiting.size()});
    with_buffer(waiting, [&](const void* buffer) {
      place.check(H5Dwrite(dataset.get(), type.get(), here.get(), there.get(), H5P_DEFAULT, buffer),
                  "write it");
    });
    written += count;
    waiting.clear();
  }
};

template <class T>
std::size_t Hdf5Rows<T>::size() const {
  return state_->row;
}

template <class T>
T* Hdf5Rows<T>::add() {
  if (state_->waiting.size() == state_->block * state_->row)
    state_->write();
  state_->waiting.resize(state_->waiting.size() + state_->row);
  return state_->waiting.data() + (state_->waiting.size() - state_->row);
}

template <class T>
void Hdf5Rows<T>::finish() {
  state_->write();
  assert(state_->row == 0 || state_->written == state_->shape.front());
}

// --- Groups that are read ---------------------------------------------------------------------------------

bool Hdf5Group::has_group(const std::string& name) const {
  return H5Lexists(state_->group.get(), name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5Group::has_attribute(const std::string& name) const {
  return H5Aexists(state_->group.get(), name.c_str()) > 0;
}

Hdf5Group Hdf5Group::group(const std::string& name) const {
  const Place place = state_->place("group", name);
  if (!has_group(name))
    place.fail("missing");
  return Hdf5Group(std::make_shared<const State>(State{
      state_->disk, place.own(H5Gopen2(state_->group.get(), name.c_str(), H5P_DEFAULT), H5Gclose, "open it"),
      state_->file, state_->path + name + "/"}));
}

template <class T>
T Hdf5Group::attribute(const std::string& name) const {
  const Place place = state_->place("attribute", name);
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    const std::vector<T> values = read_attribute_values<T>(place, state_->group.get());
    if (values.size() != 1)
      place.fail(fmt::format("{} values where one is expected", values.size()));
    return values.front();
  } else {
    return read_attribute_values<typename T::value_type>(place, state_->group.get());
  }
}

template <class T>
std::vector<T> Hdf5Group::read(const std::string& name, const std::vector<std::size_t>& shape) const {
  const Place place = state_->place("variable", name);
  return read_dataset<T>(place, open_dataset(place, state_->group.get(), shape));
}

template <class T>
std::vector<T> Hdf5Group::read_rows(const std::string& name, const std::vector<std::size_t>& shape,
                                    std::size_t first, std::size_t count) const {
  const Place place = state_->place("variable", name);
  return read_dataset<T>(place, open_dataset(place, state_->group.get(), shape),
                         rows_of_space(place, {shape.begin(), shape.end()}, first, count));
}

template <class T>
std::vector<T> Hdf5Group::read_list(const std::string& name) const {
  const Place place = state_->place("variable", name);
  const Handle dataset = open_dataset(place, state_->group.get());
  const Shape found = shape_of_dataset(place, dataset);
  if (found.size() != 1)
    place.fail(fmt::format("{} dimensions where one is expected", found.size()));
  return read_dataset<T>(place, dataset);
}

// --- What others have written -----------------------------------------------------------------------------

namespace {

bool is_text_type(hid_t type) {
  return H5Tget_class(type) == H5T_STRING;
}

bool is_number_type(hid_t type) {
  return H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT;
}

/// Texts of any length out of `read`, which fills a buffer of a given type in memory.
template <class Read>
std::vector<std::string> any_texts(hid_t type, hid_t space, std::size_t count, Read read) {
  if (H5Tis_variable_str(type) > 0)
    return from_buffer<std::string>(count, type, space, [&](void* buffer) { read(type, buffer); });
  const std::size_t length = H5Tget_size(type);
  std::vector<char> characters(length * count);
  read(type, characters.data());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    const char* const first = characters.data() + i * length;
    texts.emplace_back(first, std::find(first, first + length, '\0'));
    texts.back().erase(texts.back().find_last_not_of(' ') + 1);
  }
  return texts;
}

/// An attribute of a variable, and its type; none when there is none with one value.
struct ForeignAttribute {
  Handle attribute, type, space;

  static std::optional<ForeignAttribute> find(const Place& place, hid_t dataset) {
    if (H5Aexists(dataset, place.name.c_str()) <= 0)
      return std::nullopt;
    Handle attribute = place.own(H5Aopen(dataset, place.name.c_str(), H5P_DEFAULT), H5Aclose, "open it");
    Handle type = place.own(H5Aget_type(attribute.get()), H5Tclose, "read its type");
    Handle space = place.own(H5Aget_space(attribute.get()), H5Sclose, "read its shape");
    if (H5Sget_simple_extent_npoints(space.get()) != 1)
      return std::nullopt;
    return ForeignAttribute{std::move(attribute), std::move(type), std::move(space)};
  }
};

herr_t keep_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

herr_t keep_scale_name(hid_t, unsigned, hid_t scale, void* name) {
  const ssize_t length = H5Iget_name(scale, nullptr, 0);
  std::string path(length > 0 ? static_cast<std::size_t>(length) + 1 : 1, '\0');
  H5Iget_name(scale, path.data(), path.size());
  path.resize(path.size() - 1);
  *static_cast<std::string*>(name) = path.substr(path.rfind('/') + 1);
  return 1;
}

}  // namespace

std::vector<std::string> Hdf5Group::variables() const {
  std::vector<std::string> links, names;
  state_->place("group", "")
      .check(H5Literate(state_->group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, keep_name, &links),
             "list it");
  for (std::string& name : links) {
    H5O_info_t info;
    if (H5Oget_info_by_name2(state_->group.get(), name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        info.type == H5O_TYPE_DATASET)
      names.push_back(std::move(name));
  }
  return names;
}

std::vector<std::size_t> Hdf5Group::shape(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Shape found = shape_of_dataset(place, open_dataset(place, state_->group.get()));
  return {found.begin(), found.end()};
}

std::vector<std::string> Hdf5Group::dimensions(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Handle dataset = open_dataset(place, state_->group.get());
  std::vector<std::string> names(shape_of_dataset(place, dataset).size());
  const bool coordinates = names.size() == 1 && H5DSis_scale(dataset.get()) > 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (coordinates)
      names[i] = variable;
    else if (H5DSget_num_scales(dataset.get(), static_cast<unsigned>(i)) > 0)
      H5DSiterate_scales(dataset.get(), static_cast<unsigned>(i), nullptr, keep_scale_name, &names[i]);
  return names;
}

bool Hdf5Group::is_number(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Handle dataset = open_dataset(place, state_->group.get());
  return is_number_type(place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type").get());
}

bool Hdf5Group::is_text(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Handle dataset = open_dataset(place, state_->group.get());
  return is_text_type(place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type").get());
}

std::vector<double> Hdf5Group::numbers(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Handle dataset = open_dataset(place, state_->group.get());
  if (!is_number(variable))
    place.fail("no numbers");
  std::vector<double> values(product(shape_of_dataset(place, dataset)));
  if (!values.empty())
    place.check(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                "read it");
  return values;
}

std::vector<std::string> Hdf5Group::texts(const std::string& variable) const {
  const Place place = state_->place("variable", variable);
  const Handle dataset = open_dataset(place, state_->group.get());
  const Handle type = place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type");
  const Handle space = place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape");
  if (!is_text_type(type.get()))
    place.fail("no texts");
  return any_texts(
      type.get(), space.get(), product(shape_of_dataset(place, dataset)), [&](hid_t as, void* buffer) {
        place.check(H5Dread(dataset.get(), as, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer), "read it");
      });
}

std::optional<double> Hdf5Group::number_attribute(const std::string& variable,
                                                  const std::string& name) const {
  const Place place = state_->place("attribute", name);
  const Handle dataset = open_dataset(state_->place("variable", variable), state_->group.get());
  const auto found = ForeignAttribute::find(place, dataset.get());
  if (!found || !is_number_type(found->type.get()))
    return std::nullopt;
  double value = 0.0;
  place.check(H5Aread(found->attribute.get(), H5T_NATIVE_DOUBLE, &value), "read it");
  return value;
}

std::optional<std::string> Hdf5Group::text_attribute(const std::string& variable,
                                                     const std::string& name) const {
  const Place place = state_->place("attribute", name);
  const Handle dataset = open_dataset(state_->place("variable", variable), state_->group.get());
  const auto found = ForeignAttribute::find(place, dataset.get());
  if (!found || !is_text_type(found->type.get()))
    return std::nullopt;
  return any_texts(found->type.get(), found->space.get(), 1,
                   [&](hid_t as, void* buffer) {
                     place.check(H5Aread(found->attribute.get(), as, buffer), "read it");
                   })
      .front();
}

// --- Files ------------------------------------------------------------------------------------------------

namespace {

/// In the format of HDF5 1.8 at most, which netCDF-4 takes. Tracked objects get checksums by it. The
/// superblock must be the earliest one: of a later one H5Fget_file_image (1.10.8) spoils the checksum,
/// because it resets a flag below it. The library locks no file: ours are locked by others, or lie where
/// nobody can.
Handle file_access(const Place& place) {
  Handle access = place.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make properties");
  place.check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18), "make properties");
  place.check(H5Pset_file_locking(access.get(), false, true), "make properties");
  return access;
}

Handle memory_access(const Place& place) {
  constexpr std::size_t kGrowth = std::size_t{1} << 22;
  Handle access = file_access(place);
  place.check(H5Pset_fapl_core(access.get(), kGrowth, false), "make properties");
  return access;
}

/// A new file at `path`, which is a name only when `access` says that it is in memory.
Handle create_file(const Place& place, const std::string& path, const Handle& access) {
  const Handle creation = place.own(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "make properties");
  set_group_properties(place, creation.get());
  return place.own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
                   "create the file");
}

}  // namespace

Hdf5File Hdf5File::create(const std::string& name) {
  silence_library();
  const Place place{name, "group", "/", ""};
  return Hdf5File(Hdf5Group::State::root_of(create_file(place, name, memory_access(place)), place));
}

Hdf5File Hdf5File::create_at(const std::filesystem::path& path, const std::string& name) {
  silence_library();
  const Place place{name, "group", "/", ""};
  auto disk = std::make_shared<int>(0);
  const Handle access = file_access(place);
  int* const error = disk.get();
  place.check(H5Pset_driver(access.get(), DiskDriver::driver(), &error), "make properties");
  return Hdf5File(
      Hdf5Group::State::root_of(create_file(place, path.string(), access), place, std::move(disk)));
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  require_seal(path);
  silence_library();
  const Place place{path.string(), "group", "/", ""};
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_access(place).get()), H5Fclose);
  if (file.get() < 0)
    throw ArchiveError(fmt::format("{}: no HDF5 file, or not a whole one ({})", place.file, last_error()));
  return Hdf5File(Hdf5Group::State::root_of(file, place));
}

Hdf5File Hdf5File::open_unsealed(std::vector<std::byte> content, const std::string& name) {
  silence_library();
  const Place place{name, "group", "/", ""};
  constexpr unsigned kReadOnlyCopy = 0;
  const Handle file(H5LTopen_file_image(content.data(), content.size(), kReadOnlyCopy), H5Fclose);
  if (file.get() < 0)
    throw ArchiveError(fmt::format("{}: no HDF5 file, or not a whole one ({})", name, last_error()));
  return Hdf5File(Hdf5Group::State::root_of(file, place));
}

Hdf5Group Hdf5File::root() const {
  return Hdf5Group(root_);
}

void Hdf5File::finish() const {
  const Place place = root_->place("group", "");
  place.check(H5Fflush(root_->group.get(), H5F_SCOPE_GLOBAL), "finish the file");
  if (root_->disk && *root_->disk != 0)
    throw ArchiveError(fmt::format("{}: cannot write: {}", place.file,
                                   std::error_code(*root_->disk, std::generic_category()).message()));
}

std::vector<std::byte> Hdf5File::image() const {
  const Place place = root_->place("group", "");
  const Handle file = place.own(H5Iget_file_id(root_->group.get()), H5Fclose, "find its file");
  place.check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), "finish the file");
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  place.check(size < 0 ? -1 : 0, "measure the file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  place.check(H5Fget_file_image(file.get(), bytes.data(), bytes.size()) < 0 ? -1 : 0, "copy the file");
  return sealed(std::move(bytes));
}

// --- The types of values that there are -------------------------------------------------------------------

#define MPM_INSTANTIATE_VARIABLE(T)                                                                          \
  template void Hdf5Group::write_dimension<T>(const std::string&, const std::vector<T>&, const Attributes&); \
  template Hdf5Rows<T> Hdf5Group::create_dimension<T>(const std::string&, std::size_t, const Attributes&);   \
  template void Hdf5Group::write<T>(const std::string&, const std::vector<std::string>&,                     \
                                    const std::vector<T>&, const Attributes&);                               \
  template Hdf5Rows<T> Hdf5Group::create_rows<T>(const std::string&, const std::vector<std::string>&,        \
                                                 const Attributes&);                                         \
  template class Hdf5Rows<T>;                                                                                \
  template std::vector<T> Hdf5Group::read<T>(const std::string&, const std::vector<std::size_t>&) const;     \
  template std::vector<T> Hdf5Group::read_rows<T>(const std::string&, const std::vector<std::size_t>&,       \
                                                  std::size_t, std::size_t) const;                           \
  template std::vector<T> Hdf5Group::read_list<T>(const std::string&) const

MPM_INSTANTIATE_VARIABLE(std::int8_t);
MPM_INSTANTIATE_VARIABLE(std::int32_t);
MPM_INSTANTIATE_VARIABLE(std::int64_t);
MPM_INSTANTIATE_VARIABLE(double);
MPM_INSTANTIATE_VARIABLE(std::string);

template std::string Hdf5Group::attribute<std::string>(const std::string&) const;
template double Hdf5Group::attribute<double>(const std::string&) const;
template std::int32_t Hdf5Group::attribute<std::int32_t>(const std::string&) const;
template std::int64_t Hdf5Group::attribute<std::int64_t>(const std::string&) const;
template std::uint64_t Hdf5Group::attribute<std::uint64_t>(const std::string&) const;
template std::vector<std::int32_t> Hdf5Group::attribute<std::vector<std::int32_t>>(const std::string&) const;

}  // namespace mpm

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5_hl.h>

#include "results/archive/hdf5_dataset.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/hdf5_group_state.hpp"

// The members of Hdf5Group that read files of other programs.

namespace mpm {
namespace {

constexpr std::size_t kMostForeignBytes = 400'000'000;  // of the values of one variable

bool is_text_type(hid_t type) {
  return H5Tget_class(type) == H5T_STRING;
}

bool is_number_type(hid_t type) {
  return H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT;
}

/// Refuses values that HDF5 would read from another file, which somebody else has chosen.
void refuse_other_file(const hdf5::Place& place, bool other) {
  if (other)
    place.refuse("values that lie in another file", "values in this one");
}

unsigned long file_number(const hdf5::Place& place, hid_t object) {
  H5O_info_t info;
  place.check(H5Oget_info2(object, &info, H5O_INFO_BASIC), "look at it");
  return info.fileno;
}

/// Opens a variable and checks that its values are in this file.
hdf5::Handle open_own_dataset(const hdf5::Place& place, hid_t group) {
  hdf5::Handle dataset = open_dataset(place, group);
  const hdf5::Handle properties =
      place.own(H5Dget_create_plist(dataset.get()), H5Pclose, "read its properties");
  refuse_other_file(place, file_number(place, dataset.get()) != file_number(place, group) ||
                               H5Pget_external_count(properties.get()) != 0 ||
                               H5Pget_layout(properties.get()) == H5D_VIRTUAL);
  return dataset;
}

/// Returns how many values a variable has, of `bytes` each. Refuses a variable that is too large for the
/// memory.
std::size_t bounded_count(const hdf5::Place& place, const hdf5::Shape& shape, std::size_t bytes) {
  const std::string most = fmt::format("at most {} bytes", kMostForeignBytes);
  hsize_t count = 1;
  for (const hsize_t length : shape) {
    if (length != 0 && count > kMostForeignBytes / length)
      place.refuse(fmt::format("shape ({}), too many values", fmt::join(shape, ", ")), most);
    count *= length;
  }
  if (count > kMostForeignBytes / bytes)
    place.refuse(fmt::format("{} values of {} bytes, too many", count, bytes), most);
  return count;
}

/// Returns texts of any length; `read` fills a buffer of a given type in memory.
template <class Read>
std::vector<std::string> any_texts(hid_t type, hid_t space, std::size_t count, Read read) {
  if (H5Tis_variable_str(type) > 0)
    return hdf5::from_buffer<std::string>(count, type, space, [&](void* buffer) { read(type, buffer); });
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

/// An attribute of a variable and its type, if there is one. An attribute with several values is refused.
struct ForeignAttribute {
  hdf5::Handle attribute, type, space;

  static std::optional<ForeignAttribute> find(const hdf5::Place& place, hid_t dataset) {
    if (H5Aexists(dataset, place.name.c_str()) <= 0)
      return std::nullopt;
    hdf5::Handle attribute =
        place.own(H5Aopen(dataset, place.name.c_str(), H5P_DEFAULT), H5Aclose, "open it");
    hdf5::Handle type = place.own(H5Aget_type(attribute.get()), H5Tclose, "read its type");
    hdf5::Handle space = place.own(H5Aget_space(attribute.get()), H5Sclose, "read its shape");
    if (const hssize_t values = H5Sget_simple_extent_npoints(space.get()); values != 1)
      place.refuse(fmt::format("{} values", values), "one");
    return ForeignAttribute{std::move(attribute), std::move(type), std::move(space)};
  }
};

herr_t keep_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

/// Returns the names of the objects of a kind in a group. An object in another file is refused when it is
/// read.
std::vector<std::string> names_in(const hdf5::Place& place, hid_t group, H5O_type_t kind) {
  std::vector<std::string> links, names;
  place.check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep_name, &links), "list it");
  for (std::string& name : links) {
    H5O_info_t info;
    if (H5Oget_info_by_name2(group, name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        info.type == kind)
      names.push_back(std::move(name));
  }
  return names;
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
  return names_in(state_->place("group", ""), state_->group.get(), H5O_TYPE_DATASET);
}

std::vector<std::string> Hdf5Group::groups() const {
  return names_in(state_->place("group", ""), state_->group.get(), H5O_TYPE_GROUP);
}

std::vector<std::size_t> Hdf5Group::shape(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Shape found = shape_of_dataset(place, open_own_dataset(place, state_->group.get()));
  return {found.begin(), found.end()};
}

std::vector<std::string> Hdf5Group::dimensions(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
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
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  return is_number_type(place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type").get());
}

bool Hdf5Group::is_text(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  return is_text_type(place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type").get());
}

bool Hdf5Group::is_reference(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  const hdf5::Handle type = place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type");
  return H5Tequal(type.get(), H5T_STD_REF_OBJ) > 0;
}

std::vector<std::string> Hdf5Group::references(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  if (!is_reference(variable))
    place.refuse("no references", "references");
  std::vector<hobj_ref_t> found(bounded_count(place, shape_of_dataset(place, dataset), sizeof(std::string)));
  if (!found.empty())
    place.check(H5Dread(dataset.get(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.data()),
                "read it");
  std::vector<std::string> paths;
  for (const hobj_ref_t& reference : found) {
    const ssize_t length = H5Rget_name(dataset.get(), H5R_OBJECT, &reference, nullptr, 0);
    std::string path(length > 0 ? static_cast<std::size_t>(length) + 1 : 1, '\0');
    H5Rget_name(dataset.get(), H5R_OBJECT, &reference, path.data(), path.size());
    path.resize(path.size() - 1);
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<double> Hdf5Group::numbers(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  if (!is_number(variable))
    place.refuse("no numbers", "numbers");
  std::vector<double> values(bounded_count(place, shape_of_dataset(place, dataset), sizeof(double)));
  if (!values.empty())
    place.check(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                "read it");
  return values;
}

std::vector<std::string> Hdf5Group::texts(const std::string& variable) const {
  const hdf5::Place place = state_->place("variable", variable);
  const hdf5::Handle dataset = open_own_dataset(place, state_->group.get());
  const hdf5::Handle type = place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type");
  const hdf5::Handle space = place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape");
  if (!is_text_type(type.get()))
    place.refuse("no texts", "texts");
  const std::size_t bytes = std::max(H5Tget_size(type.get()), sizeof(std::string));
  return any_texts(type.get(), space.get(), bounded_count(place, shape_of_dataset(place, dataset), bytes),
                   [&](hid_t as, void* buffer) {
                     place.check(H5Dread(dataset.get(), as, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer),
                                 "read it");
                   });
}

std::optional<double> Hdf5Group::number_attribute(const std::string& variable,
                                                  const std::string& name) const {
  const hdf5::Place place{state_->file, "attribute", state_->path + variable + "/", name};
  const hdf5::Handle dataset = open_own_dataset(state_->place("variable", variable), state_->group.get());
  const auto found = ForeignAttribute::find(place, dataset.get());
  if (!found)
    return std::nullopt;
  if (!is_number_type(found->type.get()))
    place.refuse("no number", "a number");
  double value = 0.0;
  place.check(H5Aread(found->attribute.get(), H5T_NATIVE_DOUBLE, &value), "read it");
  return value;
}

std::optional<std::string> Hdf5Group::text_attribute(const std::string& variable,
                                                     const std::string& name) const {
  const hdf5::Place place{state_->file, "attribute", state_->path + variable + "/", name};
  const hdf5::Handle dataset = open_own_dataset(state_->place("variable", variable), state_->group.get());
  const auto found = ForeignAttribute::find(place, dataset.get());
  if (!found)
    return std::nullopt;
  if (!is_text_type(found->type.get()))
    place.refuse("no text", "a text");
  return any_texts(found->type.get(), found->space.get(), 1,
                   [&](hid_t as, void* buffer) {
                     place.check(H5Aread(found->attribute.get(), as, buffer), "read it");
                   })
      .front();
}

}  // namespace mpm

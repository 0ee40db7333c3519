#include <cassert>
#include <cstdint>
#include <type_traits>

#include <fmt/format.h>
#include <hdf5_hl.h>

#include "results/archive/hdf5_dataset.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/hdf5_group_state.hpp"

namespace mpm {

/// The dimensions of a variable that is about to be written in this group.
struct Hdf5Group::Scales {
  std::vector<hdf5::Handle> datasets = {};
  hdf5::Shape shape = {};

  Scales(const State& group, const std::vector<std::string>& dimensions) {
    for (const std::string& dimension : dimensions) {
      const hdf5::Place place = group.place("dimension", dimension);
      datasets.push_back(open_dataset(place, group.group.get()));
      shape.push_back(shape_of_dataset(place, datasets.back()).at(0));
    }
  }

  void attach_to(const hdf5::Handle& variable, const hdf5::Place& place) const {
    for (std::size_t i = 0; i < datasets.size(); ++i)
      place.check(H5DSattach_scale(variable.get(), datasets[i].get(), static_cast<unsigned>(i)),
                  "attach its dimensions");
  }
};

Hdf5Group Hdf5Group::create_group(const std::string& name) {
  const hdf5::Place place = state_->place("group", name);
  const hdf5::Handle properties = place.own(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "make properties");
  set_group_properties(place, properties.get());
  return Hdf5Group(std::make_shared<const State>(State{
      state_->disk,
      place.own(H5Gcreate2(state_->group.get(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                H5Gclose, "create it"),
      state_->file, state_->path + name + "/"}));
}

void Hdf5Group::write_attribute(const std::string& name, const AttributeValue& value) {
  hdf5::write_attribute(state_->place("attribute", name), state_->group.get(), value);
}

template <class T>
void Hdf5Group::write_dimension(const std::string& name, const std::vector<T>& coordinates,
                                const Attributes& attributes) {
  const hdf5::Place place = state_->place("dimension", name);
  const hdf5::Handle dataset =
      write_dataset(place, state_->group.get(), {coordinates.size()}, coordinates, attributes, true);
  place.check(H5DSset_scale(dataset.get(), name.c_str()), "make it a dimension");
}

template <class T>
void Hdf5Group::write(const std::string& name, const std::vector<std::string>& dimensions,
                      const std::vector<T>& values, const Attributes& attributes) {
  const hdf5::Place place = state_->place("variable", name);
  const Scales scales(*state_, dimensions);
  const hdf5::Handle dataset =
      write_dataset(place, state_->group.get(), scales.shape, values, attributes, false);
  scales.attach_to(dataset, place);
}

template <class T>
Hdf5Rows<T> Hdf5Group::create_rows(const std::string& name, const std::vector<std::string>& dimensions,
                                   const Attributes& attributes) {
  const hdf5::Place place = state_->place("variable", name);
  const Scales scales(*state_, dimensions);
  hdf5::Handle dataset = create_dataset<T>(place, state_->group.get(), scales.shape, attributes, false);
  scales.attach_to(dataset, place);
  return Hdf5Rows<T>(std::make_shared<typename Hdf5Rows<T>::State>(place, std::move(dataset), scales.shape));
}

template <class T>
Hdf5Rows<T> Hdf5Group::create_dimension(const std::string& name, std::size_t length,
                                        const Attributes& attributes) {
  const hdf5::Place place = state_->place("dimension", name);
  hdf5::Handle dataset = create_dataset<T>(place, state_->group.get(), {length}, attributes, true);
  place.check(H5DSset_scale(dataset.get(), name.c_str()), "make it a dimension");
  return Hdf5Rows<T>(
      std::make_shared<typename Hdf5Rows<T>::State>(place, std::move(dataset), hdf5::Shape{length}));
}

// --- Variables that are written row by row ----------------------------------------------------------------

template <class T>
struct Hdf5Rows<T>::State {
  hdf5::Place place;
  hdf5::Handle dataset;
  hdf5::Shape shape;
  std::size_t row;      ///< values in a row
  std::size_t block;    ///< rows that are written at once
  hsize_t written = 0;  ///< rows written so far
  std::vector<T> waiting = {};

  State(hdf5::Place at, hdf5::Handle of, hdf5::Shape size)
      : place(std::move(at)),
        dataset(std::move(of)),
        shape(std::move(size)),
        row(hdf5::product({shape.begin() + 1, shape.end()})),
        block(row == 0 || shape.front() == 0 ? 1 : hdf5::chunk_shape(shape).front()) {}

  void write() {
    if (waiting.empty())
      return;
    const hsize_t count = waiting.size() / row;
    const hdf5::Handle type = type_of<T>(place), there = rows_of_space(place, shape, written, count),
                       here = make_space(place, {waiting.size()});
    hdf5::with_buffer(waiting, [&](const void* buffer) {
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
  const hdf5::Place place = state_->place("group", name);
  if (!has_group(name))
    place.fail("missing");
  return Hdf5Group(std::make_shared<const State>(State{
      state_->disk, place.own(H5Gopen2(state_->group.get(), name.c_str(), H5P_DEFAULT), H5Gclose, "open it"),
      state_->file, state_->path + name + "/"}));
}

template <class T>
T Hdf5Group::attribute(const std::string& name) const {
  const hdf5::Place place = state_->place("attribute", name);
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    const std::vector<T> values = hdf5::read_attribute<T>(place, state_->group.get());
    if (values.size() != 1)
      place.fail(fmt::format("{} values where one is expected", values.size()));
    return values.front();
  } else {
    return hdf5::read_attribute<typename T::value_type>(place, state_->group.get());
  }
}

template <class T>
std::vector<T> Hdf5Group::read(const std::string& name, const std::vector<std::size_t>& shape) const {
  const hdf5::Place place = state_->place("variable", name);
  return read_dataset<T>(place, open_dataset(place, state_->group.get(), shape));
}

template <class T>
std::vector<T> Hdf5Group::read_rows(const std::string& name, const std::vector<std::size_t>& shape,
                                    std::size_t first, std::size_t count) const {
  const hdf5::Place place = state_->place("variable", name);
  return read_dataset<T>(place, open_dataset(place, state_->group.get(), shape),
                         rows_of_space(place, {shape.begin(), shape.end()}, first, count));
}

template <class T>
std::vector<T> Hdf5Group::read_list(const std::string& name) const {
  const hdf5::Place place = state_->place("variable", name);
  const hdf5::Handle dataset = open_dataset(place, state_->group.get());
  const hdf5::Shape found = shape_of_dataset(place, dataset);
  if (found.size() != 1)
    place.fail(fmt::format("{} dimensions where one is expected", found.size()));
  return read_dataset<T>(place, dataset);
}

// --- The types of values ----------------------------------------------------------------------------------

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

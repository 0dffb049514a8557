#include "core/hdf5.h"

#include <hdf5.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/file_seal.h"

namespace simwright::core {
namespace {

constexpr std::size_t kMostDimensions = 32;      // H5S_MAX_RANK
constexpr std::size_t kMaxTextBytes = 16 << 20;  // for an attribute, or all strings of a dataset

// Returns the innermost error message of the library's last failure.
std::string LibraryReason() {
  std::string reason;
  const auto keep = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason.empty() ? "" : ": " + reason;
}

[[noreturn]] void Fail(const std::string& what, const std::string& where) {
  throw Error(what + LibraryReason(), where);
}

// Disables the library's error printing, a per-thread setting.
void Silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

template <typename T>
hid_t NativeType() {
  if constexpr (std::is_same_v<T, float>) {
    return H5T_NATIVE_FLOAT;
  } else if constexpr (std::is_same_v<T, double>) {
    return H5T_NATIVE_DOUBLE;
  } else if constexpr (std::is_same_v<T, std::uint8_t>) {
    return H5T_NATIVE_UINT8;
  } else {
    return H5T_NATIVE_INT64;
  }
}

// Returns the type stored in the file, independent of the machine's byte order.
template <typename T>
hid_t FileType() {
  if constexpr (std::is_same_v<T, float>) {
    return H5T_IEEE_F32LE;
  } else if constexpr (std::is_same_v<T, double>) {
    return H5T_IEEE_F64LE;
  } else if constexpr (std::is_same_v<T, std::uint8_t>) {
    return H5T_STD_U8LE;
  } else {
    return H5T_STD_I64LE;
  }
}

}  // namespace

// An identifier of the library and the function that releases it.
class Hdf5Group::Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (H5Iis_valid(id_) > 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t id() const { return id_; }

  // Throws core::Error if the library returned no identifier.
  static std::shared_ptr<Handle> Of(hid_t id, Close close, const std::string& what,
                                    const std::string& where) {
    if (id < 0) Fail(what, where);
    return std::make_shared<Handle>(id, close);
  }

 private:
  hid_t id_;
  Close close_;
};

std::string Hdf5Group::At(const std::string& name) const {
  return place_ + "/" + name;
}

std::vector<std::string> Hdf5Group::Children() const {
  std::vector<std::string> names;
  const auto keep = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  if (H5Literate(group_->id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &names) < 0) {
    Fail("cannot list the group", place_);
  }
  return names;
}

bool Hdf5Group::Has(const std::string& name) const {
  return H5Lexists(group_->id(), name.c_str(), H5P_DEFAULT) > 0 &&
         H5Oexists_by_name(group_->id(), name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Group Hdf5Group::Create(const std::string& name) {
  const hid_t id = H5Gcreate2(group_->id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return Hdf5Group(Handle::Of(id, H5Gclose, "cannot create the group", At(name)), At(name));
}

Hdf5Group Hdf5Group::Open(const std::string& name) const {
  if (!Has(name)) throw Error("there is no such group", At(name));
  const hid_t id = H5Gopen2(group_->id(), name.c_str(), H5P_DEFAULT);
  return Hdf5Group(Handle::Of(id, H5Gclose, "this is not a group", At(name)), At(name));
}

void Hdf5Group::SetAttribute(const std::string& name, std::int64_t value) {
  const auto space = Handle::Of(H5Screate(H5S_SCALAR), H5Sclose, "no space", At(name));
  const auto attribute = Handle::Of(
      H5Acreate2(group_->id(), name.c_str(), H5T_STD_I64LE, space->id(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "cannot make the attribute", At(name));
  if (H5Awrite(attribute->id(), H5T_NATIVE_INT64, &value) < 0) {
    Fail("cannot write the attribute", At(name));
  }
}

void Hdf5Group::SetAttribute(const std::string& name, const std::string& text) {
  const auto type = Handle::Of(H5Tcopy(H5T_C_S1), H5Tclose, "no type", At(name));
  H5Tset_size(type->id(), H5T_VARIABLE);
  H5Tset_cset(type->id(), H5T_CSET_UTF8);
  const auto space = Handle::Of(H5Screate(H5S_SCALAR), H5Sclose, "no space", At(name));
  const auto attribute = Handle::Of(
      H5Acreate2(group_->id(), name.c_str(), type->id(), space->id(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "cannot make the attribute", At(name));
  const char* pointer = text.c_str();
  if (H5Awrite(attribute->id(), type->id(), &pointer) < 0) {
    Fail("cannot write the attribute", At(name));
  }
}

std::int64_t Hdf5Group::IntegerAttribute(const std::string& name) const {
  const auto attribute = Handle::Of(H5Aopen(group_->id(), name.c_str(), H5P_DEFAULT), H5Aclose,
                                    "there is no such attribute", At(name));
  const auto type = Handle::Of(H5Aget_type(attribute->id()), H5Tclose, "no type", At(name));
  const auto space = Handle::Of(H5Aget_space(attribute->id()), H5Sclose, "no space", At(name));
  std::int64_t value = 0;
  if (H5Tget_class(type->id()) != H5T_INTEGER || H5Sget_simple_extent_npoints(space->id()) != 1 ||
      H5Aread(attribute->id(), H5T_NATIVE_INT64, &value) < 0) {
    Fail("the attribute is not an integer", At(name));
  }
  return value;
}

std::string Hdf5Group::TextAttribute(const std::string& name) const {
  const auto attribute = Handle::Of(H5Aopen(group_->id(), name.c_str(), H5P_DEFAULT), H5Aclose,
                                    "there is no such attribute", At(name));
  const auto type = Handle::Of(H5Aget_type(attribute->id()), H5Tclose, "no type", At(name));
  const auto space = Handle::Of(H5Aget_space(attribute->id()), H5Sclose, "no space", At(name));
  if (H5Tget_class(type->id()) != H5T_STRING || H5Sget_simple_extent_npoints(space->id()) != 1) {
    Fail("the attribute is not a string", At(name));
  }
  if (H5Tis_variable_str(type->id()) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute->id(), type->id(), &text) < 0) Fail("cannot read the text", At(name));
    const std::string copy = text == nullptr ? "" : text;
    H5Dvlen_reclaim(type->id(), space->id(), H5P_DEFAULT, &text);
    return copy;
  }
  const std::size_t size = H5Tget_size(type->id());
  if (size > kMaxTextBytes) throw Error("the string is too long", At(name));
  std::string bytes(size, '\0');
  if (H5Aread(attribute->id(), type->id(), bytes.data()) < 0) {
    Fail("cannot read the text", At(name));
  }
  return bytes.substr(0, bytes.find('\0'));
}

template <typename T>
void Hdf5Group::Write(const std::string& name, const std::vector<std::size_t>& shape,
                      const T* values, const Hdf5Storage& storage) {
  if (shape.size() > kMostDimensions) {
    throw Error("a dataset has at most 32 dimensions", At(name));
  }
  if (shape.empty() && storage.rows_per_chunk > 0) {
    throw Error("a scalar has no chunks", At(name));
  }
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const auto rank = static_cast<int>(sizes.size());
  const auto space = Handle::Of(H5Screate_simple(rank, sizes.data(), nullptr), H5Sclose,
                                "cannot create the dataset's shape", At(name));
  const auto layout =
      Handle::Of(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no properties", At(name));
  H5Pset_obj_track_times(layout->id(), false);  // no timestamps: the same bytes in every run
  const bool holds_any =
      std::all_of(sizes.begin(), sizes.end(), [](hsize_t size) { return size > 0; });
  if (storage.gzip > 0 && storage.rows_per_chunk == 0) {
    throw Error("a contiguous dataset cannot be compressed", At(name), "give rows_per_chunk");
  }
  if (storage.rows_per_chunk > 0 && holds_any) {
    std::vector<hsize_t> chunk = sizes;
    chunk[0] = std::min<hsize_t>(chunk[0], storage.rows_per_chunk);
    if (H5Pset_chunk(layout->id(), rank, chunk.data()) < 0 ||
        (storage.gzip > 0 &&
         H5Pset_deflate(layout->id(), static_cast<unsigned>(storage.gzip)) < 0)) {
      Fail("cannot set the dataset's layout", At(name));
    }
  }
  const auto dataset = Handle::Of(H5Dcreate2(group_->id(), name.c_str(), FileType<T>(), space->id(),
                                             H5P_DEFAULT, layout->id(), H5P_DEFAULT),
                                  H5Dclose, "cannot make the dataset", At(name));
  if (holds_any &&
      H5Dwrite(dataset->id(), NativeType<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    Fail("cannot write the dataset", At(name));
  }
}

void Hdf5Group::WriteTexts(const std::string& name, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& text : texts) {
    if (text.empty() || text.find('\0') != std::string::npos) {
      throw Error("a string is empty or contains a zero byte", At(name));
    }
    longest = std::max(longest, text.size());
  }
  std::string bytes;
  for (const std::string& text : texts) {
    bytes += text;
    bytes.append(longest - text.size(), '\0');
  }
  const auto type = Handle::Of(H5Tcopy(H5T_C_S1), H5Tclose, "no type", At(name));
  H5Tset_size(type->id(), longest);
  H5Tset_strpad(type->id(), H5T_STR_NULLPAD);
  const hsize_t count = texts.size();
  const auto space =
      Handle::Of(H5Screate_simple(1, &count, nullptr), H5Sclose, "no space", At(name));
  const auto layout =
      Handle::Of(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no properties", At(name));
  H5Pset_obj_track_times(layout->id(), false);
  const auto dataset = Handle::Of(H5Dcreate2(group_->id(), name.c_str(), type->id(), space->id(),
                                             H5P_DEFAULT, layout->id(), H5P_DEFAULT),
                                  H5Dclose, "cannot make the dataset", At(name));
  if (count > 0 &&
      H5Dwrite(dataset->id(), type->id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) {
    Fail("cannot write the dataset", At(name));
  }
}

void Hdf5Group::WriteText(const std::string& name, const std::string& text) {
  if (text.find('\0') != std::string::npos) throw Error("a string contains a zero byte", At(name));
  const auto type = Handle::Of(H5Tcopy(H5T_C_S1), H5Tclose, "no type", At(name));
  H5Tset_size(type->id(), H5T_VARIABLE);
  H5Tset_cset(type->id(), H5T_CSET_UTF8);
  const auto space = Handle::Of(H5Screate(H5S_SCALAR), H5Sclose, "no space", At(name));
  const auto layout =
      Handle::Of(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no properties", At(name));
  H5Pset_obj_track_times(layout->id(), false);
  const auto dataset = Handle::Of(H5Dcreate2(group_->id(), name.c_str(), type->id(), space->id(),
                                             H5P_DEFAULT, layout->id(), H5P_DEFAULT),
                                  H5Dclose, "cannot make the dataset", At(name));
  const char* pointer = text.c_str();
  if (H5Dwrite(dataset->id(), type->id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &pointer) < 0) {
    Fail("cannot write the dataset", At(name));
  }
}

std::shared_ptr<Hdf5Group::Handle> Hdf5Group::Dataset(const std::string& name) const {
  if (!Has(name)) throw Error("there is no such dataset", At(name));
  return Handle::Of(H5Dopen2(group_->id(), name.c_str(), H5P_DEFAULT), H5Dclose,
                    "this is not a dataset", At(name));
}

std::vector<std::size_t> Hdf5Group::Shape(const std::string& name) const {
  const auto dataset = Dataset(name);
  const auto space = Handle::Of(H5Dget_space(dataset->id()), H5Sclose, "no space", At(name));
  const int rank = H5Sget_simple_extent_ndims(space->id());
  if (rank < 0) Fail("cannot read the dataset's shape", At(name));
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space->id(), sizes.data(), nullptr);
  return {sizes.begin(), sizes.end()};
}

template <typename T>
void Hdf5Group::ReadInto(const std::string& name, std::size_t first, std::uint64_t limit,
                         Hdf5Array<T>* array) const {
  std::uint64_t count = 1;
  for (const std::size_t size : array->shape) {
    if (size > 0 && count > limit / sizeof(T) / size) {
      throw Error("the dataset is larger than " + std::to_string(limit >> 20) + " MiB", At(name));
    }
    count *= size;
  }
  const auto dataset = Dataset(name);
  const auto type = Handle::Of(H5Dget_type(dataset->id()), H5Tclose, "no type", At(name));
  const H5T_class_t wanted = std::is_floating_point_v<T> ? H5T_FLOAT : H5T_INTEGER;
  if (H5Tget_class(type->id()) != wanted || H5Tget_size(type->id()) > sizeof(T)) {
    throw Error("the dataset holds numbers of another kind", At(name));
  }
  array->values.resize(count);
  if (count == 0) return;
  const auto here = Handle::Of(H5Dget_space(dataset->id()), H5Sclose, "no space", At(name));
  const std::vector<hsize_t> sizes(array->shape.begin(), array->shape.end());
  std::vector<hsize_t> start(sizes.size(), 0);
  if (!start.empty()) {
    start[0] = first;
    H5Sselect_hyperslab(here->id(), H5S_SELECT_SET, start.data(), nullptr, sizes.data(), nullptr);
  }
  const auto memory =
      Handle::Of(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose,
                 "no space", At(name));
  if (H5Dread(dataset->id(), NativeType<T>(), memory->id(), here->id(), H5P_DEFAULT,
              array->values.data()) < 0) {
    Fail("cannot read the dataset", At(name));
  }
}

template <typename T>
Hdf5Array<T> Hdf5Group::Read(const std::string& name, std::uint64_t limit) const {
  Hdf5Array<T> array;
  array.shape = Shape(name);
  ReadInto(name, 0, limit, &array);
  return array;
}

template <typename T>
Hdf5Array<T> Hdf5Group::ReadRows(const std::string& name, std::size_t first, std::size_t count,
                                 std::uint64_t limit) const {
  Hdf5Array<T> array;
  array.shape = Shape(name);
  if (array.shape.empty() || first > array.shape[0] || count > array.shape[0] - first) {
    throw Error("the dataset has no such rows", At(name));
  }
  array.shape[0] = count;
  ReadInto(name, first, limit, &array);
  return array;
}

std::vector<std::string> Hdf5Group::ReadTexts(const std::string& name) const {
  const std::vector<std::size_t> shape = Shape(name);
  const auto dataset = Dataset(name);
  const auto type = Handle::Of(H5Dget_type(dataset->id()), H5Tclose, "no type", At(name));
  const auto space = Handle::Of(H5Dget_space(dataset->id()), H5Sclose, "no space", At(name));
  if (H5Tget_class(type->id()) != H5T_STRING || shape.size() > 1) {
    throw Error("the dataset is not a list of strings", At(name));
  }
  const std::size_t count = shape.empty() ? 1 : shape[0];
  const bool variable = H5Tis_variable_str(type->id()) > 0;
  const std::size_t size = variable ? sizeof(char*) : H5Tget_size(type->id());
  if (size == 0 || count > kMaxTextBytes / size) throw Error("the strings are too long", At(name));
  std::vector<std::string> texts;
  if (count == 0) return texts;
  if (variable) {
    std::vector<char*> pointers(count, nullptr);
    if (H5Dread(dataset->id(), type->id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0) {
      Fail("cannot read the texts", At(name));
    }
    for (const char* text : pointers) texts.emplace_back(text == nullptr ? "" : text);
    H5Dvlen_reclaim(type->id(), space->id(), H5P_DEFAULT, pointers.data());
    return texts;
  }
  std::string bytes(count * size, '\0');
  if (H5Dread(dataset->id(), type->id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) {
    Fail("cannot read the texts", At(name));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::string text = bytes.substr(i * size, size);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

template void Hdf5Group::Write(const std::string&, const std::vector<std::size_t>&, const float*,
                               const Hdf5Storage&);
template void Hdf5Group::Write(const std::string&, const std::vector<std::size_t>&, const double*,
                               const Hdf5Storage&);
template void Hdf5Group::Write(const std::string&, const std::vector<std::size_t>&,
                               const std::uint8_t*, const Hdf5Storage&);
template void Hdf5Group::Write(const std::string&, const std::vector<std::size_t>&,
                               const std::int64_t*, const Hdf5Storage&);
template Hdf5Array<float> Hdf5Group::Read(const std::string&, std::uint64_t) const;
template Hdf5Array<float> Hdf5Group::ReadRows(const std::string&, std::size_t, std::size_t,
                                              std::uint64_t) const;
template Hdf5Array<double> Hdf5Group::Read(const std::string&, std::uint64_t) const;
template Hdf5Array<double> Hdf5Group::ReadRows(const std::string&, std::size_t, std::size_t,
                                               std::uint64_t) const;
template Hdf5Array<std::uint8_t> Hdf5Group::Read(const std::string&, std::uint64_t) const;
template Hdf5Array<std::uint8_t> Hdf5Group::ReadRows(const std::string&, std::size_t, std::size_t,
                                                     std::uint64_t) const;
template Hdf5Array<std::int64_t> Hdf5Group::Read(const std::string&, std::uint64_t) const;
template Hdf5Array<std::int64_t> Hdf5Group::ReadRows(const std::string&, std::size_t, std::size_t,
                                                     std::uint64_t) const;

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : root_(nullptr, path.string()) {
  Silence();
  if (!std::filesystem::is_regular_file(path)) throw Error("no such file", path.string());
  file_ = Hdf5Group::Handle::Of(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                                "this is not an HDF5 file, or it is truncated", path.string());
  root_.group_ = Hdf5Group::Handle::Of(H5Gopen2(file_->id(), "/", H5P_DEFAULT), H5Gclose,
                                       "the file has no root", path.string());
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path)
    : staged_(path), root_(nullptr, path.string()) {
  Silence();
  const auto access =
      Hdf5Group::Handle::Of(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no properties", path.string());
  // Objects that are still open are closed with the file: a group may outlive it, but is unusable.
  H5Pset_fclose_degree(access->id(), H5F_CLOSE_STRONG);
  file_ = Hdf5Group::Handle::Of(
      H5Fcreate(staged_.staging().c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access->id()), H5Fclose,
      "cannot write the file", path.string());
  root_.group_ = Hdf5Group::Handle::Of(H5Gopen2(file_->id(), "/", H5P_DEFAULT), H5Gclose,
                                       "the file has no root", path.string());
}

void Hdf5Writer::Close() {
  if (H5Fclose(file_->id()) < 0) Fail("cannot finish writing the file", root_.place_);
}

void Hdf5Writer::Commit() {
  Close();
  staged_.Commit();
}

void Hdf5Writer::CommitSealed() {
  Close();
  SealFile(staged_.staging());
  staged_.Commit();
}

}  // namespace simwright::core

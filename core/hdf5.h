#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files.h"
#include "core/hdf5_array.h"

namespace simwright::core {

// The storage layout of a dataset.
struct Hdf5Storage {
  std::size_t rows_per_chunk = 0;  // along the first index; 0: contiguous, which excludes gzip
  int gzip = 0;                    // 0 (none) to 9
};

// A group of an HDF5 file: named groups, datasets and attributes. T is float, double, std::uint8_t
// or std::int64_t. Every method throws core::Error, naming the file and the path in it, if the
// library fails, a name is missing or taken, or an object is of another kind than requested. A
// group must not outlive its file. libhdf5 has global state: use it from one thread at a time,
// whatever the file.
class Hdf5Group {
 public:
  std::vector<std::string> Children() const;  // names, sorted as bytes
  bool Has(const std::string& name) const;
  Hdf5Group Create(const std::string& name);
  Hdf5Group Open(const std::string& name) const;

  void SetAttribute(const std::string& name, std::int64_t value);
  void SetAttribute(const std::string& name, const std::string& text);  // UTF-8, variable length
  std::int64_t IntegerAttribute(const std::string& name) const;
  std::string TextAttribute(const std::string& name) const;

  // Writes a dataset. `values` holds as many numbers as the product of `shape`, which has up to 32
  // dimensions; without any, the dataset is a scalar.
  template <typename T>
  void Write(const std::string& name, const std::vector<std::size_t>& shape, const T* values,
             const Hdf5Storage& storage = {});
  // Writes fixed-length strings, padded with zeros (numpy's type S). No string may be empty or
  // contain a zero byte.
  void WriteTexts(const std::string& name, const std::vector<std::string>& texts);
  // Writes one string as a scalar: UTF-8, variable length.
  void WriteText(const std::string& name, const std::string& text);

  std::vector<std::size_t> Shape(const std::string& name) const;
  // Reads a dataset of at most `limit` bytes: integers from integers, floating point from whichever
  // precision fits T.
  template <typename T>
  Hdf5Array<T> Read(const std::string& name, std::uint64_t limit = 4ull << 30) const;
  // Reads `count` indices of the first dimension from `first` on, which must exist.
  template <typename T>
  Hdf5Array<T> ReadRows(const std::string& name, std::size_t first, std::size_t count,
                        std::uint64_t limit = 4ull << 30) const;
  // Reads strings of fixed or variable length.
  std::vector<std::string> ReadTexts(const std::string& name) const;

 private:
  friend class Hdf5Reader;
  friend class Hdf5Writer;
  class Handle;
  Hdf5Group(std::shared_ptr<Handle> group, std::string place)
      : group_(std::move(group)), place_(std::move(place)) {}
  std::string At(const std::string& name) const;
  std::shared_ptr<Handle> Dataset(const std::string& name) const;
  // Reads rows from `first` on, as many as array->shape says.
  template <typename T>
  void ReadInto(const std::string& name, std::size_t first, std::uint64_t limit,
                Hdf5Array<T>* array) const;

  std::shared_ptr<Handle> group_;
  std::string place_;  // file and path in it, for errors
};

// An HDF5 file opened for reading. libhdf5 1.10 does not survive corrupt files (of 3000 damaged
// files 73 made it crash and 15 never returned): read only trusted or sealed (core/file_seal)
// files.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  const Hdf5Group& root() const { return root_; }

 private:
  std::shared_ptr<Hdf5Group::Handle> file_;
  Hdf5Group root_;
};

// An HDF5 file that `Commit` puts in place as a whole; without it no file appears. The same calls
// write the same bytes.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path);
  Hdf5Group& root() { return root_; }
  // Closes the file with all its groups and moves it into place. CommitSealed adds a seal
  // (core/file_seal), which other programs ignore, since it follows the length that the file
  // states.
  void Commit();
  void CommitSealed();

 private:
  void Close();

  StagedFile staged_;
  std::shared_ptr<Hdf5Group::Handle> file_;
  Hdf5Group root_;
};

}  // namespace simwright::core

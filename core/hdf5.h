#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files.h"

namespace simwright::core {

// Numbers of any shape, the last index running fastest.
template <typename T>
struct Hdf5Array {
  std::vector<std::size_t> shape;
  std::vector<T> values;  // the product of `shape`
};

// How a dataset lies in its file.
struct Hdf5Storage {
  std::size_t rows_per_chunk = 0;  // of the first index; 0: in one piece, which gzip cannot be
  int gzip = 0;                    // 0 (none) to 9
};

// A group of an HDF5 file: named groups, datasets and attributes. T is float, double, std::uint8_t
// or std::int64_t. Everything throws core::Error, naming file and place, where the library fails,
// a name is missing or taken, or something is of another kind than asked for. Lives no longer than
// its file. libhdf5 keeps state of its own: one thread at a time, whatever the file.
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

  // `values`: the product of `shape`, which has 1 to 32 dimensions.
  template <typename T>
  void Write(const std::string& name, const std::vector<std::size_t>& shape, const T* values,
             const Hdf5Storage& storage = {});
  // Bytes of one length, shorter ones padded with zeros: numpy's type S. None may be empty or hold
  // a zero.
  void WriteTexts(const std::string& name, const std::vector<std::string>& texts);

  std::vector<std::size_t> Shape(const std::string& name) const;
  // Integers from integers, floating point from either of its precisions that fits T. At most
  // `limit` bytes.
  template <typename T>
  Hdf5Array<T> Read(const std::string& name, std::uint64_t limit = 4ull << 30) const;
  // The same of `count` indices of the first dimension from `first` on, which have to be there.
  template <typename T>
  Hdf5Array<T> ReadRows(const std::string& name, std::size_t first, std::size_t count,
                        std::uint64_t limit = 4ull << 30) const;
  // Texts of fixed or variable length.
  std::vector<std::string> ReadTexts(const std::string& name) const;

 private:
  friend class Hdf5Reader;
  friend class Hdf5Writer;
  class Handle;
  Hdf5Group(std::shared_ptr<Handle> group, std::string place)
      : group_(std::move(group)), place_(std::move(place)) {}
  std::string At(const std::string& name) const;
  std::shared_ptr<Handle> Dataset(const std::string& name) const;
  // Rows `first` and on, as many as array->shape says.
  template <typename T>
  void ReadInto(const std::string& name, std::size_t first, std::uint64_t limit,
                Hdf5Array<T>* array) const;

  std::shared_ptr<Handle> group_;
  std::string place_;  // file and path, for errors
};

// An HDF5 file to be read. libhdf5 1.10 is no match for a flipped bit (of 3000 damaged files 73
// made it crash and 15 run on): read what you trust, or what is sealed (core/file_seal).
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  const Hdf5Group& root() const { return root_; }

 private:
  std::shared_ptr<Hdf5Group::Handle> file_;
  Hdf5Group root_;
};

// An HDF5 file that appears whole, by `Commit`, or not at all. The same calls, the same bytes.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path);
  Hdf5Group& root() { return root_; }
  // Closes the file with all its groups and moves it into place; with a seal (core/file_seal),
  // which other programs pass over, as it follows all that the file's own length speaks of.
  void Commit();
  void CommitSealed();

 private:
  void Close();

  StagedFile staged_;
  std::shared_ptr<Hdf5Group::Handle> file_;
  Hdf5Group root_;
};

}  // namespace simwright::core

/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_PACK_H
#define DUST_CORE_PACK_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace Dust {

/*! Numbers that T travels as: restart files and exchange between ranks know doubles only */
template <typename T> constexpr size_t numbers_of()
{
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0, "travels as doubles");
  return sizeof(T) / sizeof(double);
}

/*! Words of bits that are all clear or all set travel as their kind alone, KINDS of them in a word before the others:
 *  most words of a carrier that has lost nothing, or what is on one side, are such */
namespace PackedBits {
enum : uint64_t { CLEAR, SET, MIXED };
constexpr size_t KINDS = 32;    // two bits each

constexpr uint64_t kind_of(uint64_t word) { return word == 0 ? CLEAR : ~word == 0 ? SET : MIXED; }
/*! Numbers that so many words take at most, their number included */
constexpr size_t most(size_t words) { return 1 + (words + KINDS - 1) / KINDS + words; }
}    // namespace PackedBits

/*! Writes data as numbers, one after the other; without a buffer it only counts them */
class Packer {
 public:
  explicit Packer(double *to = nullptr) : buffer(to) {}

  void put(double number)
  {
    if (buffer) buffer[count] = number;
    count++;
  }

  /*! So many T, to the last bit; the reader must know how many */
  template <typename T> void put(const T *data, size_t items)
  {
    const size_t numbers = items * numbers_of<T>();
    if (buffer && items) std::memcpy(buffer + count, data, numbers * sizeof(double));
    count += numbers;
  }

  /*! A vector and its length */
  template <typename T> void put(const std::vector<T> &data)
  {
    put(static_cast<double>(data.size()));
    put(data.data(), data.size());
  }

  /*! A vector of bits and its length */
  void put_bits(const std::vector<uint64_t> &words)
  {
    using namespace PackedBits;
    put(static_cast<double>(words.size()));
    for (size_t first = 0; first < words.size(); first += KINDS) {
      const size_t last = std::min(first + KINDS, words.size());
      uint64_t kinds = 0;
      for (size_t k = first; k < last; k++) kinds |= kind_of(words[k]) << 2 * (k - first);
      put(&kinds, 1);
      for (size_t k = first; k < last; k++)
        if (kind_of(words[k]) == MIXED) put(&words[k], 1);
    }
  }

  int size() const { return static_cast<int>(count); }    //!< numbers so far

 private:
  double *buffer;
  size_t count = 0;
};

/*! Reads what Packer wrote, in the same order */
class Unpacker {
 public:
  explicit Unpacker(const double *from) : next(from) {}

  double number() { return *next++; }

  template <typename T> void get(T *data, size_t items)
  {
    if (items) std::memcpy(static_cast<void *>(data), next, items * sizeof(T));
    next += items * numbers_of<T>();
  }

  template <typename T> void get(std::vector<T> &data)
  {
    data.resize(static_cast<size_t>(number()));
    get(data.data(), data.size());
  }

  void get_bits(std::vector<uint64_t> &words)
  {
    using namespace PackedBits;
    words.resize(static_cast<size_t>(number()));
    uint64_t kinds = 0;
    for (size_t k = 0; k < words.size(); k++, kinds >>= 2) {
      if (k % KINDS == 0) get(&kinds, 1);
      words[k] = (kinds & 3) == SET ? ~uint64_t(0) : 0;
      if ((kinds & 3) == MIXED) get(&words[k], 1);
    }
  }

  const double *position() const { return next; }

 private:
  const double *next;
};

}    // namespace Dust

#endif

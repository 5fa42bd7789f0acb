/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_PACK_H
#define DUST_CORE_PACK_H

#include <cstddef>
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

  const double *position() const { return next; }

 private:
  const double *next;
};

}    // namespace Dust

#endif

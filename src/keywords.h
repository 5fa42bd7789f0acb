/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_KEYWORDS_H
#define LMP_DUST_KEYWORDS_H

#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class Keywords;

// a keyword of a command, and what takes its values: the one list from which commands are read and errors are made

struct Keyword {
  std::string name;
  std::function<void(Keywords &)> take;
  bool repeats = false;    // may be given more than once
};

// the numbers that a value may be; infinite ones never are

struct Range {
  static Range any();
  static Range above(double low);
  static Range at_least(double low);
  static Range from_to(double low, double high);
  Range at_most(double most) const;
  Range below(double most) const;
  Range in(const std::string &their_units) const;    // to be named with the range

  Range of_finite() const;    // with ends where it has none
  bool holds(double) const;
  std::string text() const;    // as in "must be ...": "above 0 and at most 1"

  double low, high;
  bool with_low, with_high;
  std::string units;
};

// goes over the words of a command: keywords, each followed by its values. A wrong word ends in one line that names the
// command, the keyword, the value and what is allowed. name = what the documentation calls one of several values.

class Keywords : protected Pointers {
 public:
  Keywords(class LAMMPS *, const std::string &command, int narg, char **arg);

  // all words from arg[first] on
  void read(const std::vector<Keyword> &table, int first);

  // the next value of the present keyword
  double number(const Range &, const std::string &name = "");
  int whole_number(int low, int high, const std::string &name = "");
  int whole_number_or(const std::string &word, int low, int high);    // low - 1 for that word
  bool yes_or_no();
  int one_of(const std::vector<std::string> &choices, const std::string &name = "");    // its place among the choices
  std::string word(const std::string &name);    // any but an empty one, as the name of a file
  // whether another number follows
  bool number_follows() const;

  // stops with "COMMAND KEYWORD what"
  [[noreturn]] void refuse(const std::string &what) const;

 private:
  std::string command, keyword;
  int narg, next;
  char **arg;

  std::string value(const std::string &name, const std::string &allowed);
  int in_range(const std::string &text, int low, int high, const std::string &name, const std::string &allowed) const;
  [[noreturn]] void wrong(const std::string &name, const std::string &value, const std::string &allowed) const;
};

}    // namespace LAMMPS_NS

#endif

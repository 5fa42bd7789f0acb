/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "keywords.h"

#include "error.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace LAMMPS_NS;

static constexpr double INFINITE = std::numeric_limits<double>::infinity();

/* ---------------------------------------------------------------------- */

Range Range::any() { return {-INFINITE, INFINITE, false, false, ""}; }
Range Range::above(double low) { return {low, INFINITE, false, false, ""}; }
Range Range::at_least(double low) { return {low, INFINITE, true, false, ""}; }
Range Range::from_to(double low, double high) { return {low, high, true, true, ""}; }
Range Range::at_most(double most) const { return {low, most, with_low, true, units}; }
Range Range::below(double most) const { return {low, most, with_low, false, units}; }
Range Range::in(const std::string &their_units) const { return {low, high, with_low, with_high, their_units}; }

// the same, with the limits of numbers themselves where it has none
Range Range::of_finite() const
{
  constexpr double MOST = std::numeric_limits<double>::max();
  return {std::max(low, -MOST), std::min(high, MOST), with_low || low == -INFINITE, with_high || high == INFINITE,
          units};
}

bool Range::holds(double x) const
{
  return std::isfinite(x) && (with_low ? x >= low : x > low) && (with_high ? x <= high : x < high);
}

std::string Range::text() const
{
  const std::string end = units.empty() ? "" : " " + units;
  if (with_low && with_high) return fmt::format("from {:g} to {:g}{}", low, high, end);
  std::string words;
  if (low != -INFINITE) words = fmt::format("{} {:g}", with_low ? "at least" : "above", low);
  if (high != INFINITE)
    words += fmt::format("{}{} {:g}", words.empty() ? "" : " and ", with_high ? "at most" : "below", high);
  return (words.empty() ? "a number" : words) + end;
}

/* ---------------------------------------------------------------------- */

// "a, b or c"
static std::string alternatives(const std::vector<std::string> &words)
{
  std::string text;
  for (size_t k = 0; k < words.size(); k++) text += (k == 0 ? "" : k + 1 < words.size() ? ", " : " or ") + words[k];
  return text;
}

/* ---------------------------------------------------------------------- */

Keywords::Keywords(LAMMPS *_lmp, const std::string &_command, int _narg, char **_arg) :
    Pointers(_lmp), command(_command), narg(_narg), next(_narg), arg(_arg)
{
}

/* ---------------------------------------------------------------------- */

void Keywords::read(const std::vector<Keyword> &table, int first)
{
  std::vector<bool> given(table.size(), false);
  for (next = first; next < narg;) {
    keyword = arg[next++];
    const auto found = std::find_if(table.begin(), table.end(), [this](const Keyword &k) { return k.name == keyword; });
    if (found == table.end()) {
      std::vector<std::string> known;
      known.reserve(table.size());
      for (const Keyword &k : table) known.push_back(k.name);
      error->all(FLERR, "{} has no keyword {}: use {}", command, keyword, alternatives(known));
    }
    if (given[found - table.begin()] && !found->repeats) refuse("is given twice");
    given[found - table.begin()] = true;
    found->take(*this);
  }
}

/* ---------------------------------------------------------------------- */

double Keywords::number(const Range &range, const std::string &name)
{
  const std::string text = value(name, range.text());
  if (!utils::is_double(text)) wrong(name, text, range.text() == "a number" ? "a number" : "a number " + range.text());
  const double x = std::strtod(text.c_str(), nullptr);
  if (!std::isfinite(x)) wrong(name, text, range.of_finite().text());
  if (!range.holds(x)) wrong(name, text, range.text());
  return x;
}

/* ---------------------------------------------------------------------- */

static std::string whole_numbers(int low, int high)
{
  return high == MAXSMALLINT ? fmt::format("a whole number, at least {}", low)
                             : fmt::format("a whole number from {} to {}", low, high);
}

int Keywords::whole_number(int low, int high, const std::string &name)
{
  const std::string allowed = whole_numbers(low, high);
  return in_range(value(name, allowed), low, high, name, allowed);
}

int Keywords::whole_number_or(const std::string &word, int low, int high)
{
  const std::string allowed = word + " or " + whole_numbers(low, high), text = value("", allowed);
  return text == word ? low - 1 : in_range(text, low, high, "", allowed);
}

int Keywords::in_range(const std::string &text, int low, int high, const std::string &name,
                       const std::string &allowed) const
{
  if (!utils::is_integer(text)) wrong(name, text, allowed);
  errno = 0;
  const long long x = std::strtoll(text.c_str(), nullptr, 10);
  const bool too_large = x > high;
  if (too_large && high == MAXSMALLINT) wrong(name, text, fmt::format("a whole number from {} to {}", low, high));
  if (errno == ERANGE || x < low || too_large) wrong(name, text, allowed);
  return static_cast<int>(x);
}

/* ---------------------------------------------------------------------- */

bool Keywords::yes_or_no()
{
  const std::string text = value("", "yes or no");
  const bool yes = text == "yes" || text == "on" || text == "true";
  if (!yes && text != "no" && text != "off" && text != "false") wrong("", text, "yes or no");
  return yes;
}

/* ---------------------------------------------------------------------- */

int Keywords::one_of(const std::vector<std::string> &choices, const std::string &name)
{
  const std::string text = value(name, alternatives(choices));
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end()) wrong(name, text, alternatives(choices));
  return static_cast<int>(found - choices.begin());
}

/* ---------------------------------------------------------------------- */

std::string Keywords::word(const std::string &name)
{
  std::string text = value("", name);
  if (text.empty()) wrong("", "\"\"", name);
  return text;
}

/* ---------------------------------------------------------------------- */

bool Keywords::number_follows() const { return next < narg && utils::is_double(arg[next]); }

/* ---------------------------------------------------------------------- */

void Keywords::refuse(const std::string &what) const { error->all(FLERR, "{} {} {}", command, keyword, what); }

/* ---------------------------------------------------------------------- */

std::string Keywords::value(const std::string &name, const std::string &allowed)
{
  if (next < narg) return arg[next++];
  refuse(fmt::format("{}{}value is missing: it must be {}", name, name.empty() ? "" : " ", allowed));
}

void Keywords::wrong(const std::string &name, const std::string &value, const std::string &allowed) const
{
  refuse(fmt::format("{}{}value {} must be {}", name, name.empty() ? "" : " ", value, allowed));
}

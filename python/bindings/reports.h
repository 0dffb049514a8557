#pragma once

#include <string>

#include <nanobind/nanobind.h>

namespace simwright::python {

// Returns the JSON text of a report as Python's dicts and lists.
inline nanobind::object FromJson(const std::string& text) {
  return nanobind::module_::import_("json").attr("loads")(text);
}

}  // namespace simwright::python

#pragma once

#include <string_view>

// The files of viewer/web/ and third_party/three/, embedded.
namespace simwright::viewer::data {

std::string_view page_html();
std::string_view viewer_css();
std::string_view main_js();
std::string_view source_js();
std::string_view kinematics_js();
std::string_view meshes_js();
std::string_view bodies_js();
std::string_view glyphs_js();
std::string_view stage_js();
std::string_view orbit_js();
std::string_view timeline_js();
std::string_view charts_js();
std::string_view panel_js();
std::string_view elements_js();
std::string_view keys_js();
std::string_view inspection_js();
std::string_view three_module_min_js();
std::string_view three_core_min_js();

}  // namespace simwright::viewer::data

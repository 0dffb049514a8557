// COLLADA: units, axes, opacity, colours, instances; alone and inside a URDF.
#include "gltf_builder.h"
#include "mesh_files.h"

#include "assets/urdf_reader.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class DaeImport : public MeshFolder {
 protected:
  // A box between two corners, in file units.
  static std::string Dae(const std::string& asset, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high, const std::string& effect = "",
                         const std::string& nodes = "", bool colors = false) {
    std::string positions, rgb;
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < 3; ++k) {
        positions += std::to_string((i >> k & 1) != 0 ? high[k] : low[k]) + " ";
      }
      rgb += i >> 2 != 0 ? "1 0 0 " : "0 1 0 ";
    }
    const std::string floats = "type=\"float\"/>";
    std::string text =
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
        "version=\"1.4.1\"><asset>" +
        asset +
        "</asset><library_effects><effect id=\"e\">"
        "<profile_COMMON><technique sid=\"c\"><lambert><diffuse><color>0 0 1 1</color></diffuse>" +
        effect +
        "</lambert></technique></profile_COMMON></effect></library_effects>"
        "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material>"
        "</library_materials><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
        "<float_array id=\"pa\" count=\"24\">" +
        positions +
        "</float_array><technique_common>"
        "<accessor source=\"#pa\" count=\"8\" stride=\"3\"><param name=\"X\" " +
        floats + "<param name=\"Y\" " + floats + "<param name=\"Z\" " + floats +
        "</accessor></technique_common></source><source id=\"c\"><float_array id=\"ca\" "
        "count=\"24\">" +
        rgb +
        "</float_array><technique_common><accessor source=\"#ca\" "
        "count=\"8\" stride=\"3\"><param name=\"R\" " +
        floats + "<param name=\"G\" " + floats + "<param name=\"B\" " + floats +
        "</accessor></technique_common></source>"
        "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
        "<triangles count=\"12\" material=\"s\"><input semantic=\"VERTEX\" source=\"#v\" "
        "offset=\"0\"/>" +
        (colors ? "<input semantic=\"COLOR\" source=\"#c\" offset=\"0\"/>" : "") +
        "<p>0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5</p></triangles>"
        "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">";
    const std::string instance =
        "<instance_geometry url=\"#g\"><bind_material><technique_common><instance_material "
        "symbol=\"s\" target=\"#m\"/></technique_common></bind_material></instance_geometry>";
    std::string placed = nodes.empty() ? "<node id=\"n\">@</node>" : nodes;
    for (size_t at = placed.find('@'); at != std::string::npos; at = placed.find('@')) {
      placed.replace(at, 1, instance);
    }
    return text + placed +
           "</visual_scene></library_visual_scenes><scene>"
           "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  }
  static std::string Up(const std::string& axis) { return "<up_axis>" + axis + "</up_axis>"; }

  // One link with a mesh; a door's joint at `joint` hangs on it, with a box of its own.
  static std::string Urdf(const std::string& mesh, const std::string& more = "",
                          const std::string& joint = "") {
    std::string text = "<robot name=\"r\"><link name=\"body\"><visual><geometry><mesh filename=\"" +
                       mesh + "\"/></geometry></visual>" + more + "</link>";
    if (!joint.empty()) {
      text +=
          "<link name=\"door\"/><joint name=\"j\" type=\"fixed\"><parent link=\"body\"/>"
          "<child link=\"door\"/><origin xyz=\"" +
          joint + "\"/></joint>";
    }
    return text + "</robot>";
  }
  static Eigen::Vector3d SizeIn(const UrdfModel& model) {
    return core::Bounds(model.links[0].visuals[0].mesh).sizes();
  }
  static int SaidUp(const UrdfModel& model) {
    return static_cast<int>(std::count_if(model.findings.begin(), model.findings.end(),
                                          [](const auto& f) { return f.code == "urdf-mesh-up"; }));
  }
};

TEST_F(DaeImport, CoordinatesStayInTheirAxesAndBecomeMetres) {
  const Eigen::Vector3d low(0, 0, 0), high(1, 2, 3);
  for (const auto& [name, up] : {std::pair{"X_UP", 'x'}, {"Y_UP", 'y'}, {"Z_UP", 'z'}}) {
    const MeshFile file = ReadMeshFile(
        Write("a.dae", Dae("<unit name=\"centimeter\" meter=\"0.01\"/>" + Up(name), low, high)));
    EXPECT_EQ(file.up, up);
    EXPECT_NEAR((core::Bounds(file.mesh.mesh).sizes() - Eigen::Vector3d(.01, .02, .03)).norm(), 0.0,
                1e-8)
        << name;
    EXPECT_NEAR(Volume(file.mesh.mesh), 6e-6, 1e-11) << name;
  }
  EXPECT_EQ(ReadMeshFile(Write("b.dae", Dae("", low, high))).up, 0);
  EXPECT_EQ(ReadMeshFile(Write("c.dae", Dae("<up_axis> Z_UP </up_axis>", low, high))).up, 'z');
  // The rotations that map the axis to z.
  EXPECT_NEAR((ZUpRotation('y') * Eigen::Vector3d::UnitY()).z(), 1.0, 1e-12);
  EXPECT_NEAR((ZUpRotation('x') * Eigen::Vector3d::UnitX()).z(), 1.0, 1e-12);
  for (const char up : {'x', 'y', 'z'}) EXPECT_NEAR(ZUpRotation(up).determinant(), 1.0, 1e-12);
}

TEST_F(DaeImport, InstancesStandWhereTheirNodesSay) {
  const core::TexturedMesh mesh = ReadMesh(
      Write("i.dae", Dae(Up("Z_UP"), {0, 0, 0}, {1, 1, 1}, "",
                         "<node id=\"a\">@</node><node id=\"b\"><translate>5 0 0</translate>"
                         "<scale>1 1 -2</scale>@</node>")));
  EXPECT_NEAR(Volume(mesh.mesh), 3.0, 1e-6);
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  EXPECT_NEAR((box.max() - Eigen::Vector3d(6, 1, 1)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(box.min().z(), -2.0, 1e-6);
}

// The two ways of the specification to say a quarter opaque, and what SketchUp writes for opaque.
TEST_F(DaeImport, OpacityByItsModes) {
  const auto alpha = [&](const std::string& effect) {
    const MeshFile file = ReadMeshFile(Write("t.dae", Dae("", {0, 0, 0}, {1, 1, 1}, effect)));
    return std::pair(Shown(file.mesh, 0)[3], CountOf(file, "material-invisible"));
  };
  const std::string white = "<color>1 1 1 1</color></transparent>";
  EXPECT_NEAR(alpha("<transparent opaque=\"A_ONE\">" + white +
                    "<transparency><float>0.25</float></transparency>")
                  .first,
              0.25, 1e-6);
  EXPECT_NEAR(alpha("<transparent opaque=\"RGB_ZERO\">" + white +
                    "<transparency><float>0.75</float></transparency>")
                  .first,
              0.25, 1e-6);
  EXPECT_EQ(alpha("<transparency><float>0</float></transparency>"), std::pair(1.0f, 1));
}

TEST_F(DaeImport, ColoursAtVerticesAreKept) {
  const MeshFile file =
      ReadMeshFile(Write("c.dae", Dae(Up("Z_UP"), {0, 0, 0}, {1, 1, 1}, "", "", true)));
  double red_above = 0.0, green_below = 0.0;
  for (size_t t = 0; t < file.mesh.mesh.triangles.size(); ++t) {
    double z = 0.0;
    for (const int v : file.mesh.mesh.triangles[t]) z += file.mesh.mesh.vertices[v].z() / 3.0;
    if (z > 0.99) red_above += Shown(file.mesh, t)[0];
    if (z < 0.01) green_below += Shown(file.mesh, t)[1];
  }
  EXPECT_NEAR(red_above, 2.0, 0.02);  // two triangles each
  EXPECT_NEAR(green_below, 2.0, 0.02);
}

TEST_F(DaeImport, PicturesByUriAreFound) {
  WriteRedBlue("tex/my wood.png");
  std::string text = Dae("", {0, 0, 0}, {1, 1, 1});
  const std::string color = "<color>0 0 1 1</color>";
  text.replace(text.find(color), color.size(), "<texture texture=\"sampler\" texcoord=\"UV\"/>");
  const std::string profile = "<profile_COMMON>";
  text.replace(text.find(profile), profile.size(),
               profile +
                   "<newparam sid=\"surface\"><surface type=\"2D\"><init_from>i</init_from>"
                   "</surface></newparam><newparam sid=\"sampler\"><sampler2D><source>surface"
                   "</source></sampler2D></newparam>");
  // A picture shows only where it has coordinates.
  const std::string vertices = "<vertices id=\"v\">", input = "<p>0 2 1";
  text.replace(
      text.find(vertices), vertices.size(),
      "<source id=\"t\"><float_array id=\"ta\" count=\"16\">0 0 1 0 0 1 1 1 0 0 1 0 0 1 1 1"
      "</float_array><technique_common><accessor source=\"#ta\" count=\"8\" stride=\"2\">"
      "<param name=\"S\" type=\"float\"/><param name=\"T\" type=\"float\"/></accessor>"
      "</technique_common></source>" +
          vertices);
  text.replace(text.find(input), input.size(),
               "<input semantic=\"TEXCOORD\" source=\"#t\" offset=\"0\" set=\"0\"/>" + input);
  const std::string effects = "<library_effects>";
  for (const char* uri :
       {"tex/my%20wood.png", "file:///C:/models/tex/my%20wood.png", "..\\tex\\my wood.png"}) {
    std::string whole = text;
    whole.replace(whole.find(effects), effects.size(),
                  "<library_images><image id=\"i\"><init_from>" + std::string(uri) +
                      "</init_from></image></library_images>" + effects);
    EXPECT_EQ(ReadMesh(Write("p.dae", whole)).textures.size(), 1u) << uri;
  }
}

// Inside a URDF z is up: a file with z up is unchanged, one with y or x up is rotated.
TEST_F(DaeImport, UrdfsTurnMeshesToZUp) {
  const auto size = [&](const std::string& asset, const Eigen::Vector3d& high, int said) {
    Write("m.dae", Dae(asset, {0, 0, 0}, high));
    const UrdfModel model = ReadUrdf(Write("r.urdf", Urdf("m.dae")));
    EXPECT_EQ(SaidUp(model), said);
    return SizeIn(model);
  };
  const Eigen::Vector3d upright(0.4, 0.5, 0.6);
  EXPECT_NEAR((size(Up("Z_UP"), upright, 0) - upright).norm(), 0.0, 1e-6);
  EXPECT_NEAR((size(Up("Y_UP"), {0.4, 0.6, 0.5}, 1) - upright).norm(), 0.0, 1e-6);
  EXPECT_NEAR((size(Up("X_UP"), {0.6, 0.5, 0.4}, 1) - upright).norm(), 0.0, 1e-6);
  EXPECT_NEAR((size("", upright, 0) - upright).norm(), 0.0, 1e-6);
  EXPECT_NEAR((size("<unit meter=\"0.001\"/>" + Up("Z_UP"), 1000.0 * upright, 0) - upright).norm(),
              0.0, 1e-6);
}

// RViz, MoveIt and Gazebo ignore <up_axis>: files that are right there keep their pose where the
// collisions or the joints show it.
TEST_F(DaeImport, UrdfsWhosePartsFitAsTheyLieAreNotTurned) {
  const Eigen::Vector3d upright(0.4, 0.5, 0.6);
  Write("m.dae", Dae(Up("Y_UP"), {0, 0, 0}, upright));
  const std::string box =
      "<collision><origin xyz=\"0.2 0.25 0.3\"/><geometry>"
      "<box size=\"0.4 0.5 0.6\"/></geometry></collision>";
  UrdfModel model = ReadUrdf(Write("b.urdf", Urdf("m.dae", box)));
  EXPECT_NEAR((SizeIn(model) - upright).norm(), 0.0, 1e-6);
  EXPECT_EQ(SaidUp(model), 1);
  model = ReadUrdf(Write("j.urdf", Urdf("m.dae", "", "0.4 0.5 0.6")));
  EXPECT_NEAR((SizeIn(model) - upright).norm(), 0.0, 1e-6);
  // The same box around the turned mesh speaks for the file's word.
  Write("m.dae", Dae(Up("Y_UP"), {0, 0, -0.5}, {0.4, 0.6, 0}));
  model = ReadUrdf(Write("b.urdf", Urdf("m.dae", box)));
  EXPECT_NEAR((SizeIn(model) - upright).norm(), 0.0, 1e-6);
}

TEST_F(DaeImport, GltfInsideUrdfsStandsUp) {
  GltfBuilder builder;
  const int corners = builder.AddFloats({0, 0, 0, 0.4f, 0, 0, 0, 0.6f, 0, 0, 0, 0.5f}, "VEC3", 3);
  const int faces = builder.AddIndices({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});
  builder.root["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", corners}}}, {"indices", faces}}}}}};
  Write("m.glb", builder.Glb());
  const UrdfModel model = ReadUrdf(Write("r.urdf", Urdf("m.glb")));
  EXPECT_NEAR((SizeIn(model) - Eigen::Vector3d(0.4, 0.5, 0.6)).norm(), 0.0, 1e-6);
  EXPECT_EQ(SaidUp(model), 1);
  // link_from_file holds the turn: whoever reads the file again finds the same mesh.
  core::TexturedMesh again = ReadMesh(folder_ / "m.glb");
  core::Transform(model.links[0].visuals[0].link_from_file, &again.mesh);
  EXPECT_NEAR(
      (core::Bounds(again.mesh).max() - core::Bounds(model.links[0].visuals[0].mesh).max()).norm(),
      0.0, 1e-12);
}

}  // namespace
}  // namespace simwright::assets

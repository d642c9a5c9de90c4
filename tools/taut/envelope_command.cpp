#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "input.h"
#include "output.h"
#include "taut/envelope/envelope_images.h"
#include "taut/envelope/envelope_picture.h"
#include "taut/envelope/trace_envelope.h"
#include "taut/hull/convex_hull.h"
#include "text.h"

namespace taut::tool {
namespace {

struct EnvelopeArguments {
  InputArguments inputs;
  std::string prefix;
  int size = EnvelopeOptions().size;
  std::string overlay = "none";
};

std::string image_file(const EnvelopeArguments& arguments, Hemisphere hemisphere) {
  return arguments.prefix + (hemisphere == Hemisphere::north ? "-north.png" : "-south.png");
}

/// What can be told before any work is done.
void check(const EnvelopeArguments& arguments) {
  if (arguments.prefix == "-") {
    throw UsageError("three files are written, which standard output cannot hold: -o PREFIX");
  }
  for (const std::string& file :
       {image_file(arguments, Hemisphere::north), image_file(arguments, Hemisphere::south),
        arguments.prefix + ".json"}) {
    check_outputs({}, "", file, arguments.inputs.files);
  }
}

Json array_of(const dvec3& x) { return Json::array({x.x, x.y, x.z}); }

/// A contact's parameters: two on a face, one on an edge, none at a vertex.
Json parameters(const SourceContact& c) {
  if (c.kind == SourceKind::face) return Json::array({c.u, c.v});
  return c.kind == SourceKind::edge ? Json::array({c.u}) : Json::array();
}

/// column = offset + scale * n.x / (1 + pole * n.z), and the row likewise with n.y.
Json axes_of(const StereographicView& view) {
  const double half = 0.5 * view.size;
  return {{"pole", view.pole()},
          {"column", {{"coordinate", "x"}, {"offset", half - 0.5}, {"scale", half}}},
          {"row", {{"coordinate", "y"}, {"offset", half - 0.5}, {"scale", -half}}}};
}

Json curve_json(const Scene& scene, const EnvelopeCurve& curve) {
  Json n = Json::array();
  Json contacts = Json::array();
  for (const EnvelopeCurvePoint& p : curve.points) {
    n.push_back(array_of(p.n));
    Json both = Json::array();
    for (std::size_t k = 0; k < 2; ++k) {
      both.push_back({{"uv", parameters(scene.source(p.contact[k]))}, {"p", array_of(p.point[k])}});
    }
    contacts.push_back(std::move(both));
  }
  return {{"sources", curve.sources},
          {"closed", curve.closed},
          {"chain", curve.chain},
          {"n", std::move(n)},
          {"contacts", std::move(contacts)}};
}

/// PREFIX.json: the same for any number of threads.
Json document(const EnvelopeImages& images, const EnvelopeMap& map,
              const std::map<int, Color>& colors) {
  const Scene& scene = images.scene();
  Json regions = Json::array();
  for (const EnvelopeRegion& r : map.regions) {
    regions.push_back({{"source", r.source}, {"color", colors.at(r.source)}, {"pixels", r.pixels}});
  }
  Json curves = Json::array();
  for (const EnvelopeCurve& curve : map.curves) curves.push_back(curve_json(scene, curve));
  Json points = Json::array();
  for (const EnvelopeTriplePoint& p : map.triple_points) {
    Json contacts = Json::array();
    for (std::size_t k = 0; k < p.contacts.size(); ++k) {
      const SourceContact c = scene.source(p.contacts[k]);
      contacts.push_back(
          {{"source", c.source}, {"uv", parameters(c)}, {"p", array_of(p.points[k])}});
    }
    points.push_back({{"n", array_of(p.n)}, {"contacts", std::move(contacts)}});
  }
  return {{"format", "taut-envelope"},
          {"version", 1},
          {"size", images.size()},
          {"axes",
           {{"formula", "offset + scale * coordinate / (1 + pole * n.z)"},
            {"north", axes_of(images.view(Hemisphere::north))},
            {"south", axes_of(images.view(Hemisphere::south))}}},
          {"regions", std::move(regions)},
          {"curves", std::move(curves)},
          {"triple_points", std::move(points)}};
}

/// The exact hull's separating curves, and the normals of its facets.
EnvelopeOverlay overlay_of(const Hull& hull) {
  EnvelopeOverlay overlay;
  if (hull.boundary) {
    for (const SeparatingArc& arc : hull.boundary->arcs) {
      for (const ArcPiece& piece : arc.pieces) {
        overlay.curves.emplace_back();
        for (const Ruling& r : piece.rulings) overlay.curves.back().push_back(r.n);
      }
    }
    for (const HullFace& face : hull.boundary->faces) {
      if (face.kind == FaceKind::facet) overlay.points.push_back(face.n);
    }
    return overlay;
  }
  // Of a polyhedron, whose facets' normals are joined across its edges.
  std::vector<dvec3> normals;
  for (const auto face : hull.mesh.faces()) {
    dvec3 sum(0.0);
    const dvec3 origin = position(hull.mesh, *hull.mesh.cfv_begin(face));
    for (const auto h : hull.mesh.fh_range(face)) {
      sum += glm::cross(position(hull.mesh, hull.mesh.from_vertex_handle(h)) - origin,
                        position(hull.mesh, hull.mesh.to_vertex_handle(h)) - origin);
    }
    normals.push_back(unit(sum));
  }
  overlay.points = normals;
  for (const auto edge : hull.mesh.edges()) {
    const auto h = hull.mesh.halfedge_handle(edge, 0);
    const auto a = hull.mesh.face_handle(h);
    const auto b = hull.mesh.face_handle(hull.mesh.opposite_halfedge_handle(h));
    if (!a.is_valid() || !b.is_valid()) continue;
    // A great circle is no straight line in the image.
    constexpr int steps = 64;
    overlay.curves.emplace_back();
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      overlay.curves.back().push_back(
          unit((1 - t) * normals[std::size_t(a.idx())] + t * normals[std::size_t(b.idx())]));
    }
  }
  return overlay;
}

std::optional<EnvelopeOverlay> make_overlay(Input& input, const EnvelopeArguments& arguments,
                                            Console& console) {
  if (arguments.overlay != "precise") return {};
  HullOptions options;
  options.relative = 1e-3;
  options.threads = console.options().threads;
  options.progress = console.progress();
  const Hull hull = convex_hull(input.scene(), options);
  if (hull.kind != HullKind::solid) {
    console.warn("no-overlay", "the model is flat: the precise hull has no separating curves");
    return {};
  }
  if (hull.boundary && !hull.boundary->unresolved.empty()) {
    console.warn("unresolved",
                 counted(long(hull.boundary->unresolved.size()), "spot", "spots") +
                     " of the exact hull could not be resolved: curves may miss in the overlay");
  }
  return overlay_of(hull);
}

void warn_of_pixels(const EnvelopeStatistics& statistics, Console& console) {
  if (statistics.filled_pixels + statistics.empty_pixels == 0) return;
  console.warn("holes",
               counted(statistics.filled_pixels + statistics.empty_pixels, "pixel", "pixels") +
                   " of the images no surface, edge or vertex covered; they show the "
                   "nearest sampled point");
}

Json summary_json(Input& input, const EnvelopeImages& images, const EnvelopeMap& map,
                  const std::vector<std::string>& written, double seconds_map, double seconds_write,
                  const Console& console) {
  const EnvelopeStatistics& s = images.statistics();
  return {{"taut", TAUT_VERSION},
          {"input", to_json(input.summary())},
          {"size", images.size()},
          {"driver", s.driver},
          {"triangles", s.triangles},
          {"regions", map.regions.size()},
          {"curves", map.curves.size()},
          {"triple_points", map.triple_points.size()},
          {"pixels",
           {{"decided", s.decided_pixels}, {"filled", s.filled_pixels}, {"empty", s.empty_pixels}}},
          {"files", written},
          {"seconds",
           {{"read", input.seconds_read()},
            {"build", input.seconds_build()},
            {"triangles", s.seconds_triangles},
            {"draw", s.seconds_draw},
            {"decide", s.seconds_decide},
            {"trace", seconds_map},
            {"write", seconds_write},
            {"total", console.seconds()}}},
          {"peak_bytes", peak_bytes()},
          {"warnings", to_json(console.warnings())}};
}

ExitCode run(const EnvelopeArguments& arguments, Console& console) {
  check(arguments);
  Input input(arguments.inputs, console);
  EnvelopeOptions options;
  options.size = arguments.size;
  options.threads = console.options().threads;
  options.progress = console.progress();
  const EnvelopeImages images(input.scene(), options);
  warn_of_pixels(images.statistics(), console);
  const Stopwatch tracing;
  options.progress.update("trace", 0);
  const EnvelopeMap map = trace_envelope(images, options.progress);
  const double seconds_map = tracing.seconds();
  const auto overlay = make_overlay(input, arguments, console);

  options.progress.update("write", 0);
  const Stopwatch writing;
  const std::map<int, Color> colors = source_colors(images);
  std::vector<std::string> written;
  for (const Hemisphere hemisphere : hemispheres) {
    written.push_back(image_file(arguments, hemisphere));
    write_text(written.back(), to_png(envelope_picture(images, map, colors, hemisphere,
                                                       overlay.value_or(EnvelopeOverlay{}))));
    options.progress.check();
  }
  written.push_back(arguments.prefix + ".json");
  write_text(written.back(), text(document(images, map, colors)));
  const double seconds_write = writing.seconds();
  console.clear();
  if (console.options().json) {
    console.print(
        text(summary_json(input, images, map, written, seconds_map, seconds_write, console)));
  } else if (!console.options().quiet) {
    const EnvelopeStatistics& s = images.statistics();
    std::string lines = counted(long(map.regions.size()), "region", "regions") + ", " +
                        counted(map.chain_count(), "separating curve", "separating curves") + ", " +
                        counted(long(map.triple_points.size()), "triple point", "triple points") +
                        "\n" + "seconds " + number(console.seconds(), 3) + ": read " +
                        number(input.seconds_read(), 2) + ", build " +
                        number(input.seconds_build(), 2) + ", triangles " +
                        number(s.seconds_triangles, 2) + ", draw " + number(s.seconds_draw, 2) +
                        ", decide " + number(s.seconds_decide, 2) + ", trace " +
                        number(seconds_map, 2) + ", write " + number(seconds_write, 2) + "\n";
    for (const std::string& file : written) lines += "wrote " + one_line(file) + "\n";
    console.print(lines);
  }
  return ExitCode::done;
}

}  // namespace

Command add_envelope(CLI::App& parent) {
  Command command = add_command(
      parent, "envelope", "Images of the upper envelope",
      "Draws which face, edge or vertex supports in each direction, as two images of the sphere "
      "of\n"
      "directions by stereographic projection: PREFIX-north.png and PREFIX-south.png, one colour "
      "a\n"
      "source. PREFIX.json holds the regions with their colours, the separating curves and the\n"
      "triple points that the images show.\n\n"
      "Examples:\n"
      "  taut envelope teapot.bpt -o teapot\n"
      "  taut envelope teapot.bpt -o teapot --size 2048 --overlay precise");
  const auto arguments = std::make_shared<EnvelopeArguments>();
  CLI::App& app = *command.app;
  add_inputs(app, arguments->inputs);
  app.add_option("-o,--output", arguments->prefix, "What the names of the three files begin with")
      ->required()
      ->type_name("PREFIX");
  add_integer(app, "--size", arguments->size, 8, 16000,
              "Width and height of the images in pixels, default " + number(long(arguments->size)))
      ->type_name("N");
  app.add_option("--overlay", arguments->overlay,
                 "precise: the exact hull's separating curves are drawn over the\nimages in "
                 "white, and its facets in red")
      ->check(CLI::IsMember({"none", "precise"}).description(""))
      ->type_name("none|precise");
  command.run = [arguments](Console& console) { return run(*arguments, console); };
  return command;
}

}  // namespace taut::tool

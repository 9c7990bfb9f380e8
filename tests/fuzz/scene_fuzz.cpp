/// Reads a scene from any bytes. It is refused with reasons; or it can be described, written and read back to the same
/// text, and run for at most 50 steps without an exception.
#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace wingspread;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Scene scene;
  const std::string text(test::text_of(data, size));
  if (!test::takes([&] { scene = read_scene(parse_json(text)); })) return 0;
  test::demand(!describe(scene).empty(), "a scene can be described");
  const Json written = write_scene(scene);
  const Json again = write_scene(read_scene(parse_json(written.dump())));
  test::demand(again == written, "a scene that is written reads back to itself");
  Integration integration;
  integration.t_end = 1;
  integration.max_steps = 50;
  (void)Deployment().run(scene, integration, {});
  return 0;
}

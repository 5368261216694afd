// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/bake.hpp>
#include <taut/queue.hpp>

#include "bake/bake_report.hpp"
#include "bake/image_file.hpp"
#include "bake/texture_tiles.hpp"
#include "bake/textured_surface.hpp"

namespace taut::tools
{

/// A texture that is to be made anew.
struct bake_task
{
    std::string name; ///< for people
    texture_content content = texture_content::colour;
    corner_uv from, to; ///< in the old atlas and the new one; no numbers where left out
    bool old_in_tiles = false, new_in_tiles = false;
    bake_params params;
    double rotation = 0;                           ///< of directions, added to those of the texture
    std::string extension = ".png";                ///< of the new files
    int bits = 0;                                  ///< of PNG; 0: those of the old one
    std::string difference;                        ///< ending of a picture of differences, or nothing
    std::function<image_file(idx tile)> load = {}; ///< decodes an old texture, as it is stored
};

/// Files of a texture by tile.
struct baked_files
{
    std::map<idx, std::string> images, differences;
};

/// Makes textures anew. An image is decoded when it is needed, and a few are kept; new ones are encoded at once, and
/// what is compared with the old ones is what their files hold.
class texture_baker
{
public:
    /// Adds to the textures and notes of a report.
    texture_baker(queue& q, const textured_surface& old, const textured_surface& next, bake_report& report)
        : queue_(q), old_(old), new_(next), report_(report)
    {
    }

    /// Throws io_error, unsuitable_input, device_error.
    baked_files bake(const bake_task& task);

    /// Of numbers at corners; `from` and `load` of the task are not used.
    baked_files bake_corners(const bake_task& task, std::span<const float> values, idx channels);

private:
    /// Images by tile that are decoded when they are needed: some are kept.
    class decoded_images
    {
    public:
        explicit decoded_images(std::function<image_file(idx)> load) : load_(std::move(load)) {}
        std::shared_ptr<const image_file> at(idx tile);

    private:
        std::function<image_file(idx)> load_;
        std::vector<std::pair<idx, std::shared_ptr<const image_file>>> kept_; // the last one used at the end
    };

    /// Tangents of a task in both atlases.
    struct tangents
    {
        std::vector<corner_tangents> old, next;
    };

    image_file load_old(const bake_task& task, idx tile);
    image_file load_new(const bake_task& task, const baked_files& files, idx tile) const;
    tangents tangents_of(const bake_task& task) const;
    void bake_rows(const bake_task& task, bool back, std::span<const idx> triangles, const image_file& image, idx tile,
                   idx other_tile, const bake_params& params, const impl::take_texels& take);
    baked_texture bake_tile(const bake_task& task, bool back, const std::map<idx, std::vector<idx>>& parts, idx tile,
                            bake_params params, decoded_images& images);
    std::string finished(const bake_task& task, baked_texture& baked, image_numbers numbers);
    void note_cut_off(const bake_task& task);
    void compare(const bake_task& task, const triangles_of_tiles& parts, decoded_images& old, baked_files& files);

    queue& queue_;
    const textured_surface &old_, &new_;
    bake_report& report_;
    tangents tangents_;                         // of the task
    corner_uv back_to_;                         // `from` of the task, of triangles with an area
    idx channels_ = 0;                          // of the old textures of the task
    std::size_t cut_off_ = 0, not_numbers_ = 0; // texels whose numbers the files do not hold
    double low_ = 0, high_ = 1;                 // of these
};

} // namespace taut::tools

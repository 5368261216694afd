// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace taut::view
{

/// The language of page and program: binary messages, little-endian, one a frame; docs/howto/view.md has the table.

/// A message that is none. what() says where it ends to make sense.
class message_error : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// Pin of a vertex: bit k of held says that coordinate k is x[k].
struct place
{
    std::int32_t vertex;
    std::uint8_t held;
    double x[3];
};

/// Requests of a page.
namespace ask
{
struct places ///< pins vertices, or moves their pins
{
    std::vector<place> pins;
};
struct release ///< takes pins back
{
    std::vector<std::int32_t> vertices;
};
struct focus ///< holds all outside of some faces; of none: nothing
{
    std::vector<std::int32_t> faces;
};
struct relax ///< goes on until it has converged; afresh: from a new first map
{
    bool afresh;
};
struct align ///< gives a coordinate of vertices one value, their mean
{
    std::uint8_t axis;
    std::vector<std::int32_t> vertices;
};
struct undo
{
};
struct redo
{
};
struct save
{
};
struct pose ///< puts the feature elsewhere
{
    std::int32_t onto; ///< a vertex of what is shown; -1: where it is
    double turn, scale, softness;
};
struct move ///< puts the feature on a vertex that lies there from where it is
{
    double by[3]; ///< in the space of the model
};
struct keep ///< makes what is pasted a part of the target
{
};
struct seen ///< the state of this number has been drawn: the next one may come
{
    std::uint32_t state;
};
} // namespace ask

using wish = std::variant<ask::places, ask::release, ask::focus, ask::relax, ask::align, ask::undo, ask::redo,
                          ask::save, ask::pose, ask::move, ask::keep, ask::seen>;

/// Wishes of one gesture, say of a drag, are undone together.
struct message
{
    std::uint32_t gesture;
    wish what;
};

/// Throws message_error: a kind that there is not, too short or too long, numbers that are not finite.
message parse(std::span<const unsigned char> bytes);

enum class showing : std::uint8_t
{
    shape, ///< that deforms
    map,   ///< of a surface
    paste  ///< of a feature on a surface
};

/// Model to be shown. Points have three coordinates.
struct model
{
    std::uint8_t dimension; ///< of the positions in states: 2 or 3
    showing what;
    std::string name;                             ///< of the file
    std::vector<float> points;                    ///< at rest, from the first one
    std::vector<std::uint32_t> faces;             ///< three corners each
    std::uint32_t first_of_feature = 0xffffffffu; ///< the faces from there on are the feature's
};

/// State at one time.
struct state
{
    std::uint32_t number = 0;
    bool converged = false;
    bool held = true; ///< pins are at their places
    bool working = false;
    bool can_undo = false, can_redo = false;
    std::uint32_t flipped = 0;
    double energy = 0;
    double distance = 0;                      ///< of the farthest vertex from its pin
    double seconds = 0;                       ///< from the wishes to this state
    double turn = 0, scale = 1, softness = 0; ///< of the feature that is pasted
    std::vector<place> pins;
    double origin[3] = {};        ///< one for all states of a model
    std::vector<float> positions; ///< from the origin
};

std::string encode(const model& m);

/// writer: whether the page that gets it may change things.
std::string encode(const state& s, bool writer);

/// A sentence for the person at the page.
std::string encode_note(std::string_view text);

/// A file to be saved.
std::string encode_file(std::string_view name, std::string_view bytes);

} // namespace taut::view

#pragma once
// What the target of HTTP requests and its seeds share: the pattern that is authored, and the
// secret of the address.

namespace ayumi::fuzz {

inline constexpr const char* kAuthored = R"({"format": "ayumi.pattern/1", "name": "stand",
"robot": "hoap1", "units": {"angle": "deg"}, "defaults": {"posture": "home"},
"phases": [{"duration": 0.1, "support": "both"}],
"keyframes": [{"t": 0}, {"t": 0.1, "joints": {"l_elbow": -20}}]}
)";
inline constexpr const char* kSecret = "00112233445566778899aabbccddeeff";
inline constexpr int kPort = 8080;
/// Stands in a header for the number of bytes of the body, so that a mutated body is still read as
/// a whole.
inline constexpr const char* kLengthOfBody = "LENGTH";

}  // namespace ayumi::fuzz

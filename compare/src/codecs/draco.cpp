// Draco behind a C interface: a mesh of integer positions in, bytes out, and back.
//
// Every call returns an object that holds its result or the text of an error, and that the caller frees. A null
// pointer means that there is no memory for one. No exception leaves this file.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_encoder.h>
#include <draco/core/draco_version.h>
#include <draco/mesh/mesh.h>

namespace {

// Edgebreaker as Draco chooses it for these options, with a count of what it writes of the connectivity.
class CountingEncoder : public draco::MeshEdgebreakerEncoder {
 public:
  size_t connectivity_size() const { return connectivity_size_; }

 protected:
  draco::Status EncodeConnectivity() override {
    const size_t before = buffer()->size();
    draco::Status status = draco::MeshEdgebreakerEncoder::EncodeConnectivity();
    connectivity_size_ = buffer()->size() - before;
    return status;
  }

 private:
  size_t connectivity_size_ = 0;
};

// `work` with what it throws as text.
template <typename Result, typename Work>
Result *caught(const Work &work) noexcept {
  Result *result = new (std::nothrow) Result();
  if (result == nullptr) {
    return nullptr;
  }
  try {
    work(*result);
  } catch (const std::exception &exception) {
    try {
      result->error = exception.what();
    } catch (...) {
      delete result;
      return nullptr;
    }
  } catch (...) {
    delete result;
    return nullptr;
  }
  return result;
}

}  // namespace

extern "C" {

struct CompareDracoEncoded {
  draco::EncoderBuffer buffer;
  size_t connectivity_size = 0;
  std::string error;
};

struct CompareDracoDecoded {
  std::unique_ptr<draco::Mesh> mesh;
  const draco::PointAttribute *positions = nullptr;
  std::string error;
};

const char *compare_draco_version() { return draco::kDracoVersion; }

// `positions` has 3 integers a vertex, `faces` 3 indices a face, each below `vertex_count`. The speed is from 0 to 9.
CompareDracoEncoded *compare_draco_encode(const int32_t *positions, size_t vertex_count, const uint32_t *faces,
                                          size_t face_count, int speed) {
  return caught<CompareDracoEncoded>([=](CompareDracoEncoded &encoded) {
    const size_t most = std::numeric_limits<int32_t>::max() / 3;
    if (vertex_count > most || face_count > most) {
      encoded.error = "more vertices or corners than 31 bits count";
      return;
    }

    // The mesh, a copy.
    draco::Mesh mesh;
    mesh.SetNumFaces(face_count);
    for (size_t face = 0; face < face_count; ++face) {
      const uint32_t *corners = faces + 3 * face;
      mesh.SetFace(draco::FaceIndex(static_cast<uint32_t>(face)),
                   {draco::PointIndex(corners[0]), draco::PointIndex(corners[1]), draco::PointIndex(corners[2])});
    }
    mesh.set_num_points(static_cast<uint32_t>(vertex_count));
    const size_t stride = 3 * sizeof(int32_t);
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, stride, 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<uint32_t>(vertex_count));
    mesh.attribute(id)->buffer()->Write(0, positions, stride * vertex_count);

    // Its code.
    draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
    options.SetSpeed(speed, speed);
    CountingEncoder encoder;
    encoder.SetMesh(mesh);
    const draco::Status status = encoder.Encode(options, &encoded.buffer);
    if (!status.ok()) {
      encoded.error = status.error_msg_string();
    }
    encoded.connectivity_size = encoder.connectivity_size();
  });
}

const char *compare_draco_encoded_error(const CompareDracoEncoded *encoded) {
  return encoded->error.empty() ? nullptr : encoded->error.c_str();
}

const char *compare_draco_encoded_data(const CompareDracoEncoded *encoded) { return encoded->buffer.data(); }

size_t compare_draco_encoded_size(const CompareDracoEncoded *encoded) { return encoded->buffer.size(); }

size_t compare_draco_encoded_connectivity_size(const CompareDracoEncoded *encoded) {
  return encoded->connectivity_size;
}

void compare_draco_encoded_free(CompareDracoEncoded *encoded) { delete encoded; }

CompareDracoDecoded *compare_draco_decode(const char *bytes, size_t size) {
  return caught<CompareDracoDecoded>([=](CompareDracoDecoded &decoded) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes, size);
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) {
      decoded.error = mesh.status().error_msg_string();
      return;
    }
    const draco::PointAttribute *positions = mesh.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (positions == nullptr || positions->data_type() != draco::DT_INT32 || positions->num_components() != 3) {
      decoded.error = "no positions of three integers of 32 bits";
      return;
    }
    decoded.positions = positions;
    decoded.mesh = std::move(mesh).value();
  });
}

const char *compare_draco_decoded_error(const CompareDracoDecoded *decoded) {
  return decoded->error.empty() ? nullptr : decoded->error.c_str();
}

size_t compare_draco_decoded_vertex_count(const CompareDracoDecoded *decoded) { return decoded->mesh->num_points(); }

size_t compare_draco_decoded_face_count(const CompareDracoDecoded *decoded) { return decoded->mesh->num_faces(); }

// Writes 3 integers a vertex and 3 indices a face, for the counts above.
void compare_draco_decoded_copy(const CompareDracoDecoded *decoded, int32_t *positions, uint32_t *faces) {
  const size_t stride = 3 * sizeof(int32_t);
  const uint32_t vertex_count = decoded->mesh->num_points();
  for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    const auto value = decoded->positions->mapped_index(draco::PointIndex(vertex));
    std::memcpy(positions + 3 * static_cast<size_t>(vertex), decoded->positions->GetAddress(value), stride);
  }
  const uint32_t face_count = decoded->mesh->num_faces();
  for (uint32_t face = 0; face < face_count; ++face) {
    const draco::Mesh::Face &corners = decoded->mesh->face(draco::FaceIndex(face));
    for (size_t corner = 0; corner < 3; ++corner) {
      faces[3 * static_cast<size_t>(face) + corner] = corners[corner].value();
    }
  }
}

void compare_draco_decoded_free(CompareDracoDecoded *decoded) { delete decoded; }

}  // extern "C"

//! STL by `stl_io`.

use std::io::Cursor;

use meshweft::attribute::Semantic;

use crate::tally::{Opened, Tally, bits, bits_of_f32};

fn compare(file: &Opened, tally: &mut Tally) -> Result<(), String> {
    let mut bytes = Cursor::new(&file.bytes);
    let triangles = stl_io::create_stl_reader(&mut bytes).map_err(|error| error.to_string())?;
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for triangle in triangles {
        let triangle = triangle.map_err(|error| error.to_string())?;
        let corners = triangle.vertices.iter();
        positions.extend(corners.flat_map(|corner| bits_of_f32(&corner.0)));
        normals.extend(bits_of_f32(&triangle.normal.0));
    }

    for info in file.attributes() {
        let ours = bits(&file.read(&info).values);
        match info.semantic {
            Semantic::Position => {
                let ours = file.of_corners(&ours, 3);
                tally.compare((file, &info), 3, &ours, &positions);
            }
            Semantic::Normal => tally.compare((file, &info), 3, &ours, &normals),
            // `validate/attributes_trimesh.py` compares it.
            _ => tally.leave_out(1, "attribute bytes, which stl_io drops"),
        }
    }
    Ok(())
}

#[test]
fn stl_io_reads_the_same_values() {
    Tally::of_files("STL, stl_io", "stl", Vec::new(), compare);
}

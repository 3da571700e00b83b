//! Any bytes as a history in JSON lines: no panic, and what is accepted is read again as it was
//! written, and every sequence update has the faces of each level.
#![no_main]

use libfuzzer_sys::fuzz_target;
use meshweft::order::baselines;
use meshweft::progressive::{AdaptiveUpdate, History, SimpleUpdate, SmartUpdate};
use meshweft::{FaceOrder, Limits};

fuzz_target!(|data: &[u8]| {
    // A vertex takes a few bytes of memory and none of the file.
    let mut limits = Limits::default();
    limits.vertices = 1 << 16;
    let Ok(history) = History::read_json_lines(data, limits) else {
        return;
    };
    let mut text = Vec::new();
    history
        .write_json_lines(&mut text)
        .expect("memory takes all");
    let again = History::read_json_lines(&text[..], limits);
    assert_eq!(again.expect("what is written can be read"), history);

    // Down in a few jumps, and back.
    let order: FaceOrder = baselines::random(history.full_faces().len(), 1).into();
    let length = history.len();
    let levels = [1, 2, length / 2, length, length / 3, 1, 0].map(|level| level.min(length));
    let mut simple = SimpleUpdate::new(&history, &order).expect("an order of all faces");
    let mut smart = SmartUpdate::new(&history, &order).expect("an order of all faces");
    let mut adaptive = AdaptiveUpdate::new(&history, &order).expect("an order of all faces");
    for level in levels {
        let faces = history.faces_at(level);
        assert_eq!(faces.len(), history.face_count(level));
        simple.go_to(level);
        smart.go_to(level);
        adaptive.go_to(level);
        let mut numbers = [Vec::new(), Vec::new(), Vec::new()];
        simple.emit(&mut numbers[0]);
        smart.emit(&mut numbers[1]);
        adaptive.emit(&mut numbers[2]);
        for numbers in &mut numbers {
            if level == 0 {
                assert_eq!(numbers, order.new_to_old());
            }
            numbers.sort_unstable();
            assert_eq!(*numbers, faces);
        }
        assert_eq!(history.fine_to_coarse(level).len(), history.vertex_count());
    }
});

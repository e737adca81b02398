//! The index of a recording's messages, which the reader that Foxglove is built on demands: every entry is where its message is.

use std::collections::BTreeMap;

use tenax_frames::mcap::{Packing, Writer};

const HEAD: usize = 9;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;
const MESSAGE_INDEX: u8 = 7;
const CHUNK_INDEX: u8 = 8;

fn number<const N: usize>(bytes: &[u8], at: usize) -> usize {
    let mut all = [0; 8];
    all[..N].copy_from_slice(&bytes[at..at + N]);
    usize::try_from(u64::from_le_bytes(all)).unwrap()
}

/// Records from here on: place, kind and content.
fn records(file: &[u8]) -> Vec<(usize, u8, &[u8])> {
    let (mut at, mut all) = (8, Vec::new());
    while at + HEAD <= file.len() {
        let length = number::<8>(file, at + 1);
        all.push((at, file[at], &file[at + HEAD..at + HEAD + length]));
        at += HEAD + length;
    }
    all
}

#[test]
fn every_message_is_found_by_its_entry() {
    let mut writer = Writer::new(Vec::new(), Packing::SMALL).unwrap();
    let topics = ["/a", "/b"].map(|topic| writer.channel(topic, "tenax.A", b"descriptor"));
    for n in 0..5_000_u64 {
        writer.message(topics[usize::from(n % 3 == 0)], 1_000 + n, n, &n.to_le_bytes()).unwrap();
    }
    let file = writer.finish().unwrap();
    let all = records(&file);
    let by_place: BTreeMap<usize, (u8, &[u8])> =
        all.iter().map(|(at, kind, content)| (*at, (*kind, *content))).collect();
    let (mut chunks, mut found) = (0, Vec::new());
    for (_, _, index) in all.iter().filter(|(_, kind, _)| *kind == CHUNK_INDEX) {
        let (kind, chunk) = by_place[&number::<8>(index, 16)];
        assert_eq!(kind, CHUNK);
        let packed = number::<8>(chunk, 36);
        let inside = zstd::decode_all(&chunk[44..44 + packed]).unwrap();
        let places = &index[36..36 + number::<4>(index, 32)];
        let length = number::<8>(index, 36 + places.len());
        let mut lengths = 0;
        for place in places.chunks(10) {
            let (kind, own) = by_place[&number::<8>(place, 2)];
            assert_eq!((kind, number::<2>(own, 0)), (MESSAGE_INDEX, number::<2>(place, 0)));
            lengths += HEAD + own.len();
            for entry in own[6..6 + number::<4>(own, 2)].chunks(16) {
                let (at_ns, at) = (number::<8>(entry, 0), number::<8>(entry, 8));
                let message = &inside[at + HEAD..];
                assert_eq!((inside[at], number::<8>(message, 6)), (MESSAGE, at_ns));
                assert_eq!(number::<2>(message, 0), number::<2>(own, 0));
                found.push(number::<8>(message, 22));
            }
        }
        assert_eq!(lengths, length);
        chunks += 1;
    }
    found.sort_unstable();
    assert!(
        chunks > 1 && found == (0..5_000).collect::<Vec<_>>(),
        "{chunks} chunks, {} messages",
        found.len()
    );
}

//! Tags that are read, by the names of their numbers.

pub(super) const SUBFILE: u16 = 254;
pub(super) const WIDTH: u16 = 256;
pub(super) const HEIGHT: u16 = 257;
pub(super) const BITS: u16 = 258;
pub(super) const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC: u16 = 262;
pub(super) const FILL_ORDER: u16 = 266;
pub(super) const STRIP_OFFSETS: u16 = 273;
pub(super) const ORIENTATION: u16 = 274;
pub(super) const BANDS: u16 = 277;
pub(super) const ROWS_PER_STRIP: u16 = 278;
pub(super) const STRIP_BYTES: u16 = 279;
pub(super) const PREDICTOR: u16 = 317;
pub(super) const TILE_WIDTH: u16 = 322;
pub(super) const TILE_HEIGHT: u16 = 323;
pub(super) const TILE_OFFSETS: u16 = 324;
pub(super) const TILE_BYTES: u16 = 325;
pub(super) const SAMPLE_FORMAT: u16 = 339;
pub(super) const PIXEL_SCALE: u16 = 33_550;
pub(super) const TIE_POINTS: u16 = 33_922;
pub(super) const TRANSFORMATION: u16 = 34_264;
pub(super) const GEO_KEYS: u16 = 34_735;
pub(super) const GEO_NUMBERS: u16 = 34_736;
pub(super) const GDAL_METADATA: u16 = 42_112;
pub(super) const GDAL_NO_DATA: u16 = 42_113;

/// All of them.
pub(super) const ALL: [u16; 25] = [
    SUBFILE,
    WIDTH,
    HEIGHT,
    BITS,
    COMPRESSION,
    PHOTOMETRIC,
    FILL_ORDER,
    STRIP_OFFSETS,
    ORIENTATION,
    BANDS,
    ROWS_PER_STRIP,
    STRIP_BYTES,
    PREDICTOR,
    TILE_WIDTH,
    TILE_HEIGHT,
    TILE_OFFSETS,
    TILE_BYTES,
    SAMPLE_FORMAT,
    PIXEL_SCALE,
    TIE_POINTS,
    TRANSFORMATION,
    GEO_KEYS,
    GEO_NUMBERS,
    GDAL_METADATA,
    GDAL_NO_DATA,
];

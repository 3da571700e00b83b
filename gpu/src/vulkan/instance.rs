//! The loader, and the cards that its drivers have.

use std::ffi::CStr;
use std::fmt;

use ash::{Entry, vk};

use crate::error::GpuError;

/// Vulkan, loaded.
pub struct Instance {
    pub(super) raw: ash::Instance,
    // Dropped after `raw`: its functions are in the library that this keeps open.
    _entry: Entry,
}

/// What a card is, so far as counts and times depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// As the driver names it.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// What kind of card it is.
    pub kind: Kind,
    /// Who made card and driver.
    pub(crate) driver_id: vk::DriverId,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) limits: Limits,
    pub(super) subgroups_in_vertex_shaders: bool,
    /// Whether shaders can tell which draw of a call they are in.
    pub(super) draw_parameters: bool,
}

/// How a card stands to the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Kind {
    /// A card with memory of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// Lent by a virtual machine, or not known.
    Other,
    /// A program: its times say nothing of a card.
    Software,
}

/// The limits that draws are checked against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    pub(super) index: u32,
    pub(super) storage_bytes: u32,
    pub(super) indirect_draws: u32,
    pub(super) nanoseconds_per_tick: f32,
}

impl Instance {
    /// Opens the loader.
    ///
    /// # Errors
    /// If there is no loader, or no driver that it can open.
    pub fn new() -> Result<Self, GpuError> {
        // SAFETY: the library that the system has by the loader's name is the Vulkan loader, whose
        // initialisation has no conditions.
        let entry = unsafe { Entry::load() }.map_err(|error| {
            GpuError::NoDriver(format!("the loader cannot be opened ({error})"))
        })?;
        let application = vk::ApplicationInfo::default()
            .application_name(c"meshweft-gpu")
            .api_version(vk::API_VERSION_1_2);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: `info` and what it points to live until the call returns; the instance is destroyed
        // by `drop` before the library is closed.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| {
            GpuError::NoDriver(format!("the loader finds no driver that works ({result})"))
        })?;
        Ok(Self { raw, _entry: entry })
    }

    /// All cards, those that are most of a card first.
    ///
    /// # Errors
    /// If there is none.
    pub fn cards(&self) -> Result<Vec<Card>, GpuError> {
        // SAFETY: the instance is alive.
        let found = unsafe { self.raw.enumerate_physical_devices() }
            .map_err(GpuError::when("listing cards"))?;
        let mut cards: Vec<Card> = found.into_iter().filter_map(|raw| self.card(raw)).collect();
        if cards.is_empty() {
            return Err(GpuError::NoDriver("no driver has a card".to_owned()));
        }
        // Stable, so that the same machine gives the same list.
        cards.sort_by_key(|card| card.kind);
        Ok(cards)
    }

    /// What a card is; nothing if it is older than Vulkan 1.1.
    fn card(&self, physical: vk::PhysicalDevice) -> Option<Card> {
        // SAFETY: `physical` is a card of this instance, which is alive.
        let version = unsafe { self.raw.get_physical_device_properties(physical) }.api_version;
        if version < vk::API_VERSION_1_1 {
            return None;
        }

        // What it says of itself.
        let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroups);
        if version >= vk::API_VERSION_1_2 {
            all = all.push_next(&mut driver);
        }
        // SAFETY: as above; the card's version knows each structure of the chain.
        unsafe { self.raw.get_physical_device_properties2(physical, &mut all) };

        let mut parameters = vk::PhysicalDeviceShaderDrawParametersFeatures::default();
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut parameters);
        // SAFETY: as above.
        unsafe {
            self.raw
                .get_physical_device_features2(physical, &mut features)
        };
        let draw_parameters = parameters.shader_draw_parameters == vk::TRUE;

        // As much of that as counts.
        let base = all.properties;
        let kind = match base.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => Kind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => Kind::Integrated,
            vk::PhysicalDeviceType::CPU => Kind::Software,
            _ => Kind::Other,
        };
        let needed = vk::SubgroupFeatureFlags::BASIC | vk::SubgroupFeatureFlags::BALLOT;
        Some(Card {
            name: text(&base.device_name),
            driver: match text(&driver.driver_name) {
                name if name.is_empty() => format!("driver {:#x}", base.driver_version),
                name => format!("{name} {}", text(&driver.driver_info)),
            },
            kind,
            driver_id: driver.driver_id,
            physical,
            limits: Limits {
                index: base.limits.max_draw_indexed_index_value,
                storage_bytes: base.limits.max_storage_buffer_range,
                indirect_draws: base.limits.max_draw_indirect_count,
                nanoseconds_per_tick: base.limits.timestamp_period,
            },
            subgroups_in_vertex_shaders: subgroups
                .supported_stages
                .contains(vk::ShaderStageFlags::VERTEX)
                && subgroups.supported_operations.contains(needed),
            draw_parameters,
        })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: everything made from the instance borrows it or owns it, so nothing is left.
        unsafe { self.raw.destroy_instance(None) }
    }
}

impl fmt::Debug for Instance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Instance").finish_non_exhaustive()
    }
}

impl fmt::Display for Card {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.name, self.driver)
    }
}

/// A text of Vulkan, up to its first zero.
fn text(characters: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = characters.iter().map(|c| c.to_ne_bytes()[0]).collect();
    let text = CStr::from_bytes_until_nul(&bytes).unwrap_or_default();
    text.to_string_lossy().trim().to_owned()
}
